#include "engine/waveform_timeline.hpp"

#include <algorithm>

namespace haptoflow::engine {
namespace {

constexpr std::int64_t segmentLength = inference::segmentSamples;
constexpr std::int64_t fadeSamples = 10;
constexpr auto pastLimit = static_cast<std::int64_t>(TimelineView::pastSamples);
constexpr auto aheadLimit = static_cast<std::int64_t>(TimelineView::aheadSamples);

}  // namespace

void WaveformTimeline::open(std::span<const float, seedSamples> seedMps2) noexcept {
    overwrite(head_, seedMps2.last<inference::segmentSamples>());
    // Behind the head the past is the seed's, though something else may have sounded there: it is what the first
    // generated segment has to go on from.
    for (std::int64_t i = 0; i < segmentLength; ++i) {
        at(head_ - segmentLength + i) = seedMps2[static_cast<std::size_t>(i)];
    }
}

std::int64_t WaveformTimeline::commit(std::int64_t start,
                                      std::span<const float, inference::segmentSamples> segment) noexcept {
    const std::int64_t takeOver = std::max(start, head_);
    const std::int64_t late = takeOver - start;
    const std::int64_t end = start + segmentLength;
    // A segment from further ahead than what is committed would leave a hole.
    if (late >= segmentLength || takeOver > std::max(coveredUntil_, head_) || end - head_ > aheadLimit) {
        return -1;
    }
    overwrite(takeOver, segment.subspan(static_cast<std::size_t>(late)));
    return takeOver;
}

void WaveformTimeline::overwrite(std::int64_t start, std::span<const float> samples) noexcept {
    std::array<float, dsp::Splice::correlationSamples> continuation{};
    const std::int64_t running = std::clamp<std::int64_t>(coveredUntil_ - start, 0, dsp::Splice::correlationSamples);
    for (std::int64_t i = 0; i < running; ++i) {
        continuation[static_cast<std::size_t>(i)] = at(start + i);
    }
    dsp::Splice splice;
    splice.begin(std::span(continuation).first(static_cast<std::size_t>(running)), samples, dsp::Splice::maximumLength);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const float old = i < continuation.size() ? continuation[i] : 0.0F;
        at(start + static_cast<std::int64_t>(i)) = splice.next(old, samples[i]);
    }
    coveredUntil_ = start + static_cast<std::int64_t>(samples.size());
}

void WaveformTimeline::history(std::int64_t start, std::span<float, inference::segmentSamples> out) const noexcept {
    for (std::int64_t i = 0; i < segmentLength; ++i) {
        const std::int64_t sample = start - segmentLength + i;
        const bool known = sample >= head_ - segmentLength && sample >= 0 && sample < coveredUntil_;
        out[static_cast<std::size_t>(i)] = known ? at(sample) : 0.0F;
    }
}

void WaveformTimeline::read(std::span<float> out) noexcept {
    constexpr float gainStep = 1.0F / static_cast<float>(fadeSamples);
    for (float& sample : out) {
        const std::int64_t left = coveredUntil_ - head_;
        if (left <= 0) {
            sample = 0.0F;
            endGain_ = 0.0F;
            ++uncoveredSamples_;
            // What is later taken as the past must be what sounded.
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
    const std::int64_t begin = head_ - pastLimit;
    for (std::int64_t sample = begin; sample < out.coveredUntil; ++sample) {
        out.samplesMps2[static_cast<std::size_t>(sample - begin)] = at(sample);
    }
}

void WaveformTimeline::restore(const TimelineView& from) noexcept {
    head_ = from.head;
    coveredUntil_ = from.coveredUntil;
    const std::int64_t begin = head_ - pastLimit;
    for (std::int64_t sample = begin; sample < coveredUntil_; ++sample) {
        at(sample) = from.samplesMps2[static_cast<std::size_t>(sample - begin)];
    }
}

void WaveformTimeline::clear() noexcept {
    for (std::int64_t i = 0; i < capacity; ++i) {
        ring_[static_cast<std::size_t>(i)] = 0.0F;
    }
    coveredUntil_ = head_;
    endGain_ = 1.0F;
}

}  // namespace haptoflow::engine
