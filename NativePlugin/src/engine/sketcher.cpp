#include "engine/sketcher.hpp"

#include "skeleton/condition.hpp"
#include "skeleton/skeleton_layout.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace haptoflow::engine {
namespace {

constexpr auto segmentLength = static_cast<std::int64_t>(inference::segmentSamples);
// 5 ms.
constexpr std::int64_t fadeSamples = 10;
constexpr std::int64_t levelRampSamples = 8;
// A correction is not raised by more than 12 dB.
constexpr float largestRaise = 4.0F;
// Noise keys between those of the worker's segments, which count from 0, and those of a blend's parts.
constexpr std::uint64_t firstSegment = std::uint64_t{1} << 62U;

/// From 0 to 1 within a fade, at the sample `index` of it.
float fadedIn(std::int64_t index) noexcept {
    return static_cast<float>(std::clamp<std::int64_t>(index + 1, 0, fadeSamples + 1)) /
           static_cast<float>(fadeSamples + 1);
}

float levelRatio(float newMps2, float oldMps2) noexcept {
    const float ratio = newMps2 / oldMps2;
    return std::isfinite(ratio) ? std::clamp(ratio, 0.0F, largestRaise) : 1.0F;
}

}  // namespace

Sketcher::Sketcher(std::shared_ptr<const skeleton::Skeleton> skeleton, std::uint64_t seed, std::uint32_t voice) noexcept
    : skeleton_(std::move(skeleton)), seed_(seed), voice_(voice), track_(seed, voice) {}

void Sketcher::follow(const AudioMessage& message, double blockPosition, double sincePublishedSeconds) noexcept {
    contact_ = message.contact;
    material_ = message.material;
    prepared_ = message.sketch;
    contactPosition_ = blockPosition;
    sincePublishedSeconds_ = sincePublishedSeconds;
    if (contact_.state.material.count < 2) {
        balance_ = 1.0F;
    }
}

void Sketcher::begin(std::int64_t head, std::span<float, WaveformTimeline::seedSamples> seedMps2) noexcept {
    ring_.fill(0.0F);
    refinedFrom_ = refinedUntil_ = head;
    hasSketch_ = true;
    correctedLevelMps2_ = contact_.levelMps2;
    track_.begin(head);
    const skeleton::Phases phases = track_.at(contact_, material_, head, secondsAheadOf(head));
    const inference::SurfacePath path = track_.stretch().path;
    inference::SurfacePath before = path;
    for (std::size_t axis = 0; axis < before.startMetres.size(); ++axis) {
        before.startMetres[axis] -= before.stepMetres[axis] * static_cast<double>(segmentLength);
    }
    sketchSegment(skeleton::advanced(phases, -static_cast<double>(segmentLength)), before, head - segmentLength);
    sketchSegment(phases, path, head);
    track_.add(head);
    for (std::size_t index = 0; index < seedMps2.size(); ++index) {
        seedMps2[index] = at(head - segmentLength + static_cast<std::int64_t>(index));
    }
}

void Sketcher::renew(WaveformTimeline& timeline) noexcept {
    if (hasSketch_) {
        sketch(timeline, timeline.head());
    }
}

void Sketcher::extend(WaveformTimeline& timeline, std::size_t samples) noexcept {
    // The last samples that are covered would fade out.
    const std::int64_t needed = timeline.head() + static_cast<std::int64_t>(samples) + fadeSamples;
    while (timeline.coveredUntil() < needed) {
        hasSketch_ = true;
        sketch(timeline, timeline.coveredUntil());
    }
}

void Sketcher::sketch(WaveformTimeline& timeline, std::int64_t start) noexcept {
    Wave waveform{};
    holdCorrection(timeline, start, waveform);
    const skeleton::Phases phases = track_.at(contact_, material_, start, secondsAheadOf(start));
    sketchSegment(phases, track_.stretch().path, start);
    track_.add(start);
    for (std::size_t index = 0; index < waveform.size(); ++index) {
        waveform[index] += at(start + static_cast<std::int64_t>(index));
    }
    timeline.continueWith(start, waveform);
    correctedLevelMps2_ = contact_.levelMps2;
}

void Sketcher::sketchSegment(const skeleton::Phases& phases, const inference::SurfacePath& path,
                             std::int64_t start) noexcept {
    const float levelMps2 = prepared_.levelMps2 * balance_;
    Wave noise{};
    fillNoise(track_.stretch().surface, path, {.seed = seed_, .voice = voice_, .segment = firstSegment + segments_},
              noise);
    ++segments_;
    Wave previous{};
    for (std::int64_t back = 1; back <= static_cast<std::int64_t>(skeleton::filterOrder); ++back) {
        previous[static_cast<std::size_t>(segmentLength - back)] =
            skeleton::limitedOrZero(at(start - back) / levelMps2, skeleton::unitLimit);
    }
    const skeleton::Moment moment{.embedding = material_.embedding,
                                  .motion = contact_.ranged.motion,
                                  .phases = phases,
                                  .previous = previous,
                                  .noise = noise};
    Wave segment{};
    skeleton_->sketch(moment, prepared_.parameters, segment);
    for (std::size_t index = 0; index < segment.size(); ++index) {
        at(start + static_cast<std::int64_t>(index)) = segment[index] * levelMps2;
    }
}

void Sketcher::holdCorrection(const WaveformTimeline& timeline, std::int64_t start, Wave& correction) const noexcept {
    timeline.history(start + segmentLength, correction);
    const std::int64_t known = std::clamp<std::int64_t>(timeline.coveredUntil() - start, 0, segmentLength);
    const float ratio = levelRatio(contact_.levelMps2, correctedLevelMps2_);
    float last = 0.0F;
    if (known == 0) {
        Wave before{};
        timeline.history(start, before);
        last = before.back() - at(start - 1);
    }
    for (std::int64_t index = 0; index < segmentLength; ++index) {
        float& sample = correction[static_cast<std::size_t>(index)];
        if (index < known) {
            const float reached = std::min(1.0F, static_cast<float>(index + 1) / static_cast<float>(levelRampSamples));
            last = (sample - at(start + index)) * (1.0F + (ratio - 1.0F) * reached);
            sample = last;
        } else {
            sample = last * (1.0F - fadedIn(index - known));
        }
    }
}

Sketcher::Taken Sketcher::take(WaveformTimeline& timeline, const QueuedSegment& segment) noexcept {
    const bool isNewest = segment.update == contact_.updates;
    return isNewest || !segment.hasSketch ? takeWhole(timeline, segment) : takeCorrection(timeline, segment);
}

Sketcher::Taken Sketcher::takeWhole(WaveformTimeline& timeline, const QueuedSegment& segment) noexcept {
    const std::int64_t covered = timeline.coveredUntil();
    const std::int64_t start = timeline.commit(segment.start, segment.samplesMps2);
    if (start < 0) {
        return {};
    }
    const std::int64_t end = segment.start + segmentLength;
    const auto& sketched = segment.hasSketch ? segment.sketchMps2 : segment.samplesMps2;
    for (std::int64_t sample = start; sample < end; ++sample) {
        const float weight = sample < covered ? fadedIn(sample - start) : 1.0F;
        at(sample) += (sketched[static_cast<std::size_t>(sample - segment.start)] - at(sample)) * weight;
    }
    track_ = segment.track;
    correctedLevelMps2_ = segment.levelMps2;
    balance_ = segment.balance;
    hasSketch_ = segment.hasSketch;
    noteRefined(start, end);
    return {.use = Use::whole, .start = start};
}

Sketcher::Taken Sketcher::takeCorrection(WaveformTimeline& timeline, const QueuedSegment& segment) noexcept {
    const std::int64_t first = std::max(segment.start, timeline.head());
    const std::int64_t last = std::min(segment.start + segmentLength, timeline.coveredUntil());
    if (first >= last || !hasSketch_) {
        return {};
    }
    Wave waveform{};
    timeline.history(first + segmentLength, waveform);
    const float ratio = levelRatio(correctedLevelMps2_, segment.levelMps2);
    for (std::int64_t sample = first; sample < last; ++sample) {
        const auto from = static_cast<std::size_t>(sample - segment.start);
        float& played = waveform[static_cast<std::size_t>(sample - first)];
        const float corrected = at(sample) + (segment.samplesMps2[from] - segment.sketchMps2[from]) * ratio;
        played += (corrected - played) * fadedIn(sample - first);
    }
    timeline.rewrite(first, std::span(waveform).first(static_cast<std::size_t>(last - first)));
    noteRefined(first, last);
    return {.use = Use::correction, .start = first};
}

void Sketcher::noteRefined(std::int64_t start, std::int64_t end) noexcept {
    if (start > refinedUntil_) {
        refinedFrom_ = start;
    }
    refinedUntil_ = std::max(refinedUntil_, end);
}

double Sketcher::secondsAheadOf(std::int64_t sample) const noexcept {
    return secondsAhead(static_cast<double>(sample) - contactPosition_, contact_.ranged.readingRate,
                        sincePublishedSeconds_);
}

}  // namespace haptoflow::engine
