#pragma once

#include "engine/quality_control.hpp"
#include "engine/voice_channels.hpp"
#include "engine/waveform.hpp"
#include "inference/segment_generator.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

namespace haptoflow::engine {

struct PlannerSettings {
    /// Key of the voice's noise.
    std::uint64_t seed = 1;
    std::uint32_t voice = 0;
    /// Lead in waveform samples at a reading rate of 1; empty for an estimated lead.
    std::optional<std::int64_t> fixedLeadSamples;
};

/// The part of a voice that runs on the worker: decides which segment is needed next, from which past it continues and
/// where it takes over. It reads a copy of the callback's waveform ahead, with the newest contact and with the
/// corrections that the callback has not taken yet; what a network makes beyond the stream is the next correction.
/// Worker thread; allocates nothing except in `serveOutputRate`.
class SegmentPlanner {
public:
    /// `skeleton` is null for a model without one.
    SegmentPlanner(VoiceChannels& channels, const PlannerSettings& settings,
                   std::shared_ptr<const skeleton::Skeleton> skeleton) noexcept;

    /// Reads the newest contact and playhead. Returns whether a segment is needed; `request` then describes it.
    [[nodiscard]] bool wake() noexcept;
    /// True while the newest contact slides, has no segment yet and waits for the callback to play its onset or to
    /// advance. The worker must then check again soon, because nothing wakes it. Each call that returns true counts
    /// against a limit, which starts anew with a generated segment.
    [[nodiscard]] bool mustPoll() noexcept;
    /// Valid until `deliver` or the next `wake`.
    [[nodiscard]] const inference::SegmentRequest& request() const noexcept { return request_; }
    /// Sends what the requested segment has beyond the stream to the callback. Returns true if the same contact needs a
    /// further segment, because at a high reading rate or a low update rate one does not last until the next update.
    [[nodiscard]] bool deliver(std::span<const float, inference::segmentSamples> segmentMps2) noexcept;
    /// Counts a failed run; no segment is sent.
    void fail() noexcept;

    /// Makes and deletes output stages and processors for the callback. Allocates. Does not throw: if no stage can be
    /// made for a rate, the voice stays silent.
    void serveOutputRate() noexcept;

private:
    [[nodiscard]] std::unique_ptr<Processors> processorsFor(double rateHz);
    void serveProcessors() noexcept;
    [[nodiscard]] bool mayReplace() const noexcept;
    void skipUntil(std::uint64_t slides) noexcept;
    void learn() noexcept;
    void copyWaveform() noexcept;
    void beginPast() noexcept;
    void prepare(std::int64_t start) noexcept;
    [[nodiscard]] std::int64_t leadSamples(std::int64_t blockAdvance, double readingRate) const noexcept;

    VoiceChannels& channels_;
    PlannerSettings settings_;
    LeadEstimator lead_;
    std::shared_ptr<const skeleton::Skeleton> skeleton_;
    // The callback's waveform as it will be when the requested segment takes over.
    Waveform ahead_;
    // The 200 samples before the present stream.
    std::array<float, inference::segmentSamples> firstPast_{};

    struct Sent {
        Correction correction;
        std::int64_t plannedHead = 0;
        double readingRate = 1.0;
        bool observed = true;
    };
    std::array<Sent, CorrectionQueue::capacity> sent_{};
    std::uint64_t sequence_ = 0;

    // Version and rate of the newest processors made.
    std::uint64_t madeVersion_ = 0;
    double madeRateHz_ = 0.0;
    // Whether the voice had an exposure guard at any time.
    bool keepsExposure_ = false;

    // Number of sliding states that got a segment or were counted as skipped.
    std::uint64_t settledSlides_ = 0;
    int polls_ = 0;
    std::uint64_t stream_ = 0;
    std::int64_t lastStart_ = 0;
    std::int64_t lastHead_ = 0;
    std::int64_t hop_ = 0;
    // Number of segments after the first for the present position of the head.
    std::int64_t replacements_ = 0;

    std::array<float, inference::segmentSamples> history_{};
    std::array<float, inference::segmentSamples> ownHistory_{};
    skeleton::NetworkInput input_;
    inference::SegmentRequest request_{.embedding = {},
                                       .motion = {},
                                       .previous = history_,
                                       .noise = input_.noise,
                                       .own = ownHistory_,
                                       .networkInput = skeleton_ != nullptr ? &input_ : nullptr};
};

}  // namespace haptoflow::engine
