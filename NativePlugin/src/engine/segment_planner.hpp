#pragma once

#include "engine/blend_balance.hpp"
#include "engine/lead_estimator.hpp"
#include "engine/rib_phase.hpp"
#include "engine/voice_channels.hpp"
#include "engine/waveform_timeline.hpp"
#include "inference/segment_generator.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <span>

namespace haptoflow::engine {

struct PlannerSettings {
    /// Key of the voice's noise.
    std::uint64_t seed = 1;
    std::uint32_t voice = 0;
    /// Empty for a lead that is learnt; otherwise this many waveform samples, at a reading rate of 1.
    std::optional<std::int64_t> fixedLeadSamples;
    /// A new segment takes over at least so many samples after the one before: 5 ms.
    std::int64_t shortestHopSamples = 10;
};

/// The worker's end of a voice: which segment it needs next, from which past, and where that takes over. The running
/// segment's unplayed part is in that past, and so are segments that the callback has not taken yet.
/// Worker thread; allocates nothing.
class SegmentPlanner {
public:
    SegmentPlanner(VoiceChannels& channels, const PlannerSettings& settings) noexcept;

    /// Looks at the newest contact and playhead. True where a segment is wanted; `request` then says which.
    [[nodiscard]] bool wake() noexcept;
    /// True while the newest contact slides, has no segment yet and waits for the callback to play its onset or to move
    /// on: look again soon, nobody will call. Not for ever: each true is one look, and a generated segment begins the
    /// count anew.
    [[nodiscard]] bool looksAgain() noexcept;
    /// Valid until `deliver` or the next `wake`.
    [[nodiscard]] const inference::SegmentRequest& request() const noexcept { return request_; }
    /// The segment that was asked for, on its way to the callback; that of a blend is levelled here. True where the
    /// same contact needs another behind it: read faster, or updated rarely, one segment does not last until the next.
    [[nodiscard]] bool deliver(std::span<float, inference::segmentSamples> segmentMps2) noexcept;
    /// Of a voice that plays a blend: what has to be generated beside its segments.
    [[nodiscard]] BlendBalance& balance() noexcept { return balance_; }
    /// The run failed: nothing goes out.
    void fail() noexcept;

    /// The worker makes and deletes output stages and processors for the callback. Allocates. Never throws: a rate that
    /// no stage can be made for leaves the voice silent.
    void serveOutputRate() noexcept;

private:
    [[nodiscard]] ProcessorSettings wantedProcessors() const;
    [[nodiscard]] std::unique_ptr<Processors> processorsFor(double rateHz) const;
    void serveProcessors() noexcept;
    [[nodiscard]] bool mayReplace() const noexcept;
    [[nodiscard]] bool awaitsCallback() const noexcept;
    void skipUntil(std::uint64_t slides) noexcept;
    void learn() noexcept;
    void restorePast() noexcept;
    void prepare(std::int64_t start) noexcept;
    [[nodiscard]] std::int64_t leadSamples(std::int64_t blockAdvance, double readingRate) const noexcept;

    VoiceChannels& channels_;
    PlannerSettings settings_;
    LeadEstimator lead_;
    // What the callback will have committed once it has taken all that was sent.
    WaveformTimeline mirror_;
    // Of the present stream.
    RibTrack ribs_;
    BlendBalance balance_;

    struct Sent {
        QueuedSegment segment;
        std::int64_t plannedHead = 0;
        double readingRate = 1.0;
        bool observed = true;
    };
    std::array<Sent, SegmentQueue::capacity> sent_{};
    std::uint64_t sequence_ = 0;
    std::uint64_t segments_ = 0;

    // Of the newest processors that were made.
    std::uint64_t madeVersion_ = 0;
    double madeRateHz_ = 0.0;

    // Sliding states that were generated for or counted as skipped.
    std::uint64_t settledSlides_ = 0;
    int looks_ = 0;
    std::uint64_t stream_ = 0;
    std::int64_t lastStart_ = 0;
    std::int64_t lastHead_ = 0;
    std::int64_t hop_ = 0;
    // Segments after the first for one place of the head.
    std::int64_t replacements_ = 0;
    std::int64_t plannedStart_ = 0;

    std::array<float, inference::segmentSamples> history_{};
    std::array<float, inference::segmentSamples> noise_{};
    inference::SegmentRequest request_{.embedding = {}, .motion = {}, .previous = history_, .noise = noise_};
};

}  // namespace haptoflow::engine
