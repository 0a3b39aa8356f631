#include "engine/waveform_timeline.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace haptoflow::engine {
namespace {

constexpr float rampSamples = 8.0F;
constexpr float lowestLevelMps2 = 1e-6F;
constexpr float neperPerDecibel = std::numbers::ln10_v<float> / 20.0F;
constexpr float largestGain = 12.0F * neperPerDecibel;
constexpr float smallestGain = -40.0F * neperPerDecibel;

float logOf(float levelMps2) noexcept {
    const bool isUsable = levelMps2 > lowestLevelMps2 && std::isfinite(levelMps2);
    return std::log(isUsable ? levelMps2 : lowestLevelMps2);
}

}  // namespace

void LevelFollower::begin(std::int64_t start, float levelMps2) noexcept {
    logLevel_ = target_ = logOf(levelMps2);
    step_ = 0.0F;
    pieces_.begin({start, logLevel_});
}

void LevelFollower::takeOver(std::int64_t start, float levelMps2) noexcept {
    pieces_.add({start, logOf(levelMps2)});
}

void LevelFollower::setLevel(float levelMps2) noexcept {
    const float target = logOf(levelMps2);
    if (target != target_) {
        target_ = target;
        step_ = (target_ - logLevel_) / rampSamples;
    }
}

void LevelFollower::process(std::int64_t start, std::span<float> samples) noexcept {
    for (float& sample : samples) {
        logLevel_ = std::abs(target_ - logLevel_) <= std::abs(step_) ? target_ : logLevel_ + step_;
        const float gain = logLevel_ - pieces_.at(start).logLevel;
        if (gain != 0.0F) {
            sample *= std::exp(std::clamp(gain, smallestGain, largestGain));
        }
        ++start;
    }
}

namespace {

constexpr std::int64_t segmentLength = inference::segmentSamples;
constexpr std::int64_t fadeSamples = 10;
constexpr auto pastLimit = static_cast<std::int64_t>(TimelineView::pastSamples);
constexpr auto aheadLimit = static_cast<std::int64_t>(TimelineView::aheadSamples);

}  // namespace

void WaveformTimeline::open(std::span<const float, seedSamples> seedMps2) noexcept {
    overwrite(head_, seedMps2.last<inference::segmentSamples>());
    // Before the head, the seed's past replaces the samples that were played, because the first generated segment
    // continues the seed.
    copyIn(head_ - segmentLength, seedMps2.first<inference::segmentSamples>());
}

void WaveformTimeline::copyIn(std::int64_t start, std::span<const float> samples) noexcept {
    const std::size_t begin = indexOf(start);
    const std::size_t untilEnd = std::min(samples.size(), ring_.size() - begin);
    std::ranges::copy(samples.first(untilEnd), ring_.begin() + static_cast<std::ptrdiff_t>(begin));
    std::ranges::copy(samples.subspan(untilEnd), ring_.begin());
}

void WaveformTimeline::copyOut(std::int64_t start, std::span<float> out) const noexcept {
    const std::size_t begin = indexOf(start);
    const std::size_t untilEnd = std::min(out.size(), ring_.size() - begin);
    std::copy_n(ring_.begin() + static_cast<std::ptrdiff_t>(begin), untilEnd, out.begin());
    std::copy_n(ring_.begin(), out.size() - untilEnd, out.begin() + static_cast<std::ptrdiff_t>(untilEnd));
}

std::int64_t WaveformTimeline::commit(std::int64_t start,
                                      std::span<const float, inference::segmentSamples> segment) noexcept {
    const std::int64_t takeOver = std::max(start, head_);
    const std::int64_t late = takeOver - start;
    const std::int64_t end = start + segmentLength;
    // A segment that starts after the last committed sample would leave a gap.
    if (late >= segmentLength || takeOver > std::max(coveredUntil_, head_) || end - head_ > aheadLimit) {
        return -1;
    }
    overwrite(takeOver, segment.subspan(static_cast<std::size_t>(late)));
    return takeOver;
}

void WaveformTimeline::continueWith(std::int64_t start,
                                    std::span<const float, inference::segmentSamples> samplesMps2) noexcept {
    copyIn(start, samplesMps2);
    coveredUntil_ = start + segmentLength;
    // A segment that takes over where one did before is spliced with this wave now.
    beforeLastSegment_ = {};
}

void WaveformTimeline::rewrite(std::int64_t start, std::span<const float> samplesMps2) noexcept {
    copyIn(start, samplesMps2);
}

Continuation WaveformTimeline::continuationFrom(std::int64_t start) const noexcept {
    constexpr auto maximum = static_cast<std::int64_t>(dsp::Splice::correlationSamples);
    Continuation continuation;
    continuation.start = start;
    continuation.count = static_cast<std::size_t>(std::clamp<std::int64_t>(coveredUntil_ - start, 0, maximum));
    copyOut(start, std::span(continuation.samplesMps2).first(continuation.count));
    return continuation;
}

void WaveformTimeline::overwrite(std::int64_t start, std::span<const float> samples) noexcept {
    // A second segment for the same start is spliced with the wave before the first one. Splicing spliced samples would
    // apply the gains twice and raise the level of the seam.
    if (start != beforeLastSegment_.start) {
        beforeLastSegment_ = continuationFrom(start);
    }
    const std::span<const float> continuation = beforeLastSegment_.known();
    copyIn(start, samples);
    dsp::Splice splice;
    splice.begin(continuation, samples, dsp::Splice::maximumLength);
    for (std::size_t i = 0; splice.active(); ++i) {
        at(start + static_cast<std::int64_t>(i)) = splice.next(continuation[i], samples[i]);
    }
    coveredUntil_ = start + static_cast<std::int64_t>(samples.size());
}

void WaveformTimeline::history(std::int64_t start, std::span<float, inference::segmentSamples> out) const noexcept {
    const std::int64_t begin = start - segmentLength;
    const std::int64_t firstKnown =
        std::clamp<std::int64_t>(std::max<std::int64_t>(head_ - segmentLength, 0), begin, start);
    const std::int64_t endKnown = std::clamp(coveredUntil_, firstKnown, start);
    std::ranges::fill(out, 0.0F);
    copyOut(firstKnown, std::span<float>(out).subspan(static_cast<std::size_t>(firstKnown - begin),
                                                      static_cast<std::size_t>(endKnown - firstKnown)));
}

void WaveformTimeline::read(std::span<float> out) noexcept {
    constexpr float gainStep = 1.0F / static_cast<float>(fadeSamples);
    for (float& sample : out) {
        const std::int64_t left = coveredUntil_ - head_;
        if (left <= 0) {
            sample = 0.0F;
            endGain_ = 0.0F;
            ++uncoveredSamples_;
            // The past must contain the samples that were played.
            at(head_) = 0.0F;
            coveredUntil_ = head_ + 1;
        } else {
            const float ending = static_cast<float>(std::min(left, fadeSamples)) * gainStep;
            endGain_ = std::min(ending, endGain_ + gainStep);
            sample = at(head_) * endGain_;
            at(head_) = sample;
        }
        ++head_;
    }
}

void WaveformTimeline::view(TimelineView& out) const noexcept {
    out.head = head_;
    out.coveredUntil = std::clamp(coveredUntil_, head_, head_ + aheadLimit);
    out.beforeLastSegment = beforeLastSegment_;
    const std::int64_t begin = head_ - pastLimit;
    copyOut(begin, std::span(out.samplesMps2).first(static_cast<std::size_t>(out.coveredUntil - begin)));
}

void WaveformTimeline::restore(const TimelineView& from) noexcept {
    head_ = from.head;
    coveredUntil_ = from.coveredUntil;
    beforeLastSegment_ = from.beforeLastSegment;
    const std::int64_t begin = head_ - pastLimit;
    copyIn(begin, std::span(from.samplesMps2).first(static_cast<std::size_t>(coveredUntil_ - begin)));
}

void WaveformTimeline::clear() noexcept {
    ring_.fill(0.0F);
    coveredUntil_ = head_;
    endGain_ = 1.0F;
    beforeLastSegment_ = {};
}

}  // namespace haptoflow::engine
