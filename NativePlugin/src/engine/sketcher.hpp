#pragma once

#include "engine/contact_messages.hpp"
#include "engine/mailbox.hpp"
#include "engine/surface_phases.hpp"
#include "engine/waveform_timeline.hpp"
#include "skeleton/skeleton.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace haptoflow::engine {

/// Lets the skeleton sound at once, in the callback: every contact state is sketched from the next sample on, with the
/// level, resonance and ribs of that state, while the network still works on it.
///
/// What is played is a sketch plus the network's correction of it. A new sketch continues the old one and keeps the
/// correction, so nothing is spliced: for an unchanged contact it writes the same samples again. A segment of the
/// newest state replaces both; one of an earlier state, which came late, only its correction. A correction lasts as
/// long as its segment, and afterwards the skeleton sounds alone, as long as contact states come.
///
/// Used by one thread. Construction excepted, all functions take bounded time, allocate nothing and wait for nothing.
class Sketcher {
public:
    /// `skeleton` is not null. `seed` and `voice` key the noise.
    Sketcher(std::shared_ptr<const skeleton::Skeleton> skeleton, std::uint64_t seed, std::uint32_t voice) noexcept;

    /// Takes the newest contact. `blockPosition`: the waveform sample, with its fraction, at which the block begins;
    /// `sincePublishedSeconds`: how long before the block the contact was published.
    void follow(const AudioMessage& message, double blockPosition, double sincePublishedSeconds) noexcept;
    /// Begins a stream at `head`: writes the waveform that would have led there, and the one that follows from there.
    void begin(std::int64_t head, std::span<float, WaveformTimeline::seedSamples> seedMps2) noexcept;
    /// Sketches the newest contact from the head on, unless a segment without a sketch is played.
    void renew(WaveformTimeline& timeline) noexcept;
    /// Sketches on until the timeline covers the next `samples`.
    void extend(WaveformTimeline& timeline, std::size_t samples) noexcept;

    enum class Use { dropped, correction, whole };
    struct Taken {
        Use use = Use::dropped;
        /// The sample at which it takes over.
        std::int64_t start = 0;
    };
    /// Takes a segment of this stream.
    Taken take(WaveformTimeline& timeline, const QueuedSegment& segment) noexcept;

    [[nodiscard]] const SurfaceTrack& track() const noexcept { return track_; }
    /// Whether a segment of the network reaches a sample.
    [[nodiscard]] bool isRefined(std::int64_t sample) const noexcept {
        return sample >= refinedFrom_ && sample < refinedUntil_;
    }

private:
    static constexpr std::size_t segmentSamples = inference::segmentSamples;
    using Wave = std::array<float, segmentSamples>;

    [[nodiscard]] float& at(std::int64_t sample) noexcept {
        return ring_[static_cast<std::size_t>(sample) % ring_.size()];
    }
    [[nodiscard]] float at(std::int64_t sample) const noexcept {
        return ring_[static_cast<std::size_t>(sample) % ring_.size()];
    }
    void sketch(WaveformTimeline& timeline, std::int64_t start) noexcept;
    void sketchSegment(const skeleton::Phases& phases, const inference::SurfacePath& path, std::int64_t start) noexcept;
    Taken takeWhole(WaveformTimeline& timeline, const QueuedSegment& segment) noexcept;
    Taken takeCorrection(WaveformTimeline& timeline, const QueuedSegment& segment) noexcept;
    void noteRefined(std::int64_t start, std::int64_t end) noexcept;
    void holdCorrection(const WaveformTimeline& timeline, std::int64_t start, Wave& correction) const noexcept;
    [[nodiscard]] double secondsAheadOf(std::int64_t sample) const noexcept;

    std::shared_ptr<const skeleton::Skeleton> skeleton_;
    std::uint64_t seed_;
    std::uint32_t voice_;
    std::uint64_t segments_ = 0;

    PublishedContact contact_;
    MaterialInputs material_;
    PreparedSketch prepared_;
    double contactPosition_ = 0.0;
    double sincePublishedSeconds_ = 0.0;

    SurfaceTrack track_;
    // The sketch in waveform time, m/s^2. What the timeline has beyond it is the network's correction.
    std::array<float, 1024> ring_{};
    // Level of the contact for which the correction is scaled.
    float correctedLevelMps2_ = 1.0F;
    float balance_ = 1.0F;
    std::int64_t refinedFrom_ = 0;
    std::int64_t refinedUntil_ = 0;
    bool hasSketch_ = true;
};

}  // namespace haptoflow::engine
