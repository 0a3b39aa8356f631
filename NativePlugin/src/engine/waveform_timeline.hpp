#pragma once

#include "dsp/splice.hpp"
#include "engine/piece_list.hpp"
#include "inference/segment_generator.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace haptoflow::engine {

/// Gives the played waveform the level of the newest contact state, without the lead after which a segment of that
/// state takes over: each sample is divided by the level that its segment was generated for and multiplied by the
/// newest one. Where a segment takes over, both change together, so the seam keeps its level.
///
/// Levels change along a ramp of 4 ms. The gain is limited to 12 dB up, because quiet segments have the sensors' noise,
/// and 40 dB down. Audio thread; allocates nothing.
class LevelFollower {
public:
    /// A stream begins at a sample with a seed of this level in m/s^2 RMS.
    void begin(std::int64_t start, float levelMps2) noexcept;
    /// A segment that was generated for this level takes over at `start`, and with it every earlier one that starts
    /// there or later is dropped.
    void takeOver(std::int64_t start, float levelMps2) noexcept;
    /// The newest state's level.
    void setLevel(float levelMps2) noexcept;
    /// Applies the gain to the samples from `start` on.
    void process(std::int64_t start, std::span<float> samples) noexcept;

private:
    struct Piece {
        std::int64_t start = 0;
        // Natural logarithm of the level in m/s^2.
        float logLevel = 0.0F;
    };

    PieceList<Piece> pieces_;
    float logLevel_ = 0.0F;
    float target_ = 0.0F;
    float step_ = 0.0F;
};

/// The first samples of the wave that would have continued from `start` if no segment had taken over there. A splice
/// fades out of them.
struct Continuation {
    /// -1 if no segment has taken over yet.
    std::int64_t start = -1;
    std::size_t count = 0;
    std::array<float, dsp::Splice::correlationSamples> samplesMps2{};

    [[nodiscard]] std::span<const float> known() const noexcept { return std::span(samplesMps2).first(count); }
};

/// A copy of the committed samples of a timeline, with which another thread plans.
struct TimelineView {
    /// Capacity before and after the head.
    static constexpr std::size_t pastSamples = inference::segmentSamples;
    static constexpr std::size_t aheadSamples = 3 * inference::segmentSamples;

    std::int64_t head = 0;
    std::int64_t coveredUntil = 0;
    Continuation beforeLastSegment;
    /// Samples from head - pastSamples to coveredUntil, m/s^2.
    std::array<float, pastSamples + aheadSamples> samplesMps2{};
};

/// The waveform of a voice. Waveform time counts 2 kHz samples since the voice was opened and advances only by reading.
///
/// The samples from 200 before the head to `coveredUntil()` are committed. A segment takes over at the sample for which
/// it was generated and replaces the rest of the running segment (the paper's overwriting buffer). Allocates nothing;
/// used by one thread.
class WaveformTimeline {
public:
    static constexpr std::size_t seedSamples = model::seedSamples;

    /// Touch-down: the first 200 samples of the seed become the past without being played, the other 200 follow from
    /// the head on. If samples of an earlier touch are still committed there, they are spliced with the seed.
    void open(std::span<const float, seedSamples> seedMps2) noexcept;
    /// Commits `segment` (m/s^2), which takes over at `start` and is spliced with the wave committed there. If another
    /// segment took over at the same sample and nothing of it has been read, `segment` replaces it and is spliced with
    /// the wave before both. A late segment loses the samples that the head has passed. A segment that lies wholly in
    /// the past, would leave a gap or reaches beyond the capacity of a view is rejected. Returns the sample at which
    /// the segment took over, or -1.
    std::int64_t commit(std::int64_t start, std::span<const float, inference::segmentSamples> segment) noexcept;
    /// Commits samples that continue the wave before `start` by themselves, so that nothing is spliced. They replace
    /// all that was committed from there on. `start` lies between the head and the end of what is covered.
    void continueWith(std::int64_t start, std::span<const float, inference::segmentSamples> samplesMps2) noexcept;
    /// Changes committed samples from `start` on.
    void rewrite(std::int64_t start, std::span<const float> samplesMps2) noexcept;
    /// Writes the 200 committed samples before `start`, with zeros for missing ones. `start` is within 200 of the head.
    void history(std::int64_t start, std::span<float, inference::segmentSamples> out) const noexcept;
    /// Reads and advances. After the last committed sample it reads zeros; the 5 ms before that point fade out.
    void read(std::span<float> out) noexcept;
    /// Drops everything that was not read. The clock keeps its value.
    void clear() noexcept;

    /// Copies the committed samples within the view's capacity.
    void view(TimelineView& out) const noexcept;
    /// Sets the state from a view, so that `history` and `commit` behave like those of the viewed timeline.
    void restore(const TimelineView& from) noexcept;

    /// The next sample to read.
    [[nodiscard]] std::int64_t head() const noexcept { return head_; }
    /// The first sample that no segment covers.
    [[nodiscard]] std::int64_t coveredUntil() const noexcept { return coveredUntil_; }
    /// Number of samples read that no segment covered.
    [[nodiscard]] std::uint64_t uncoveredSamples() const noexcept { return uncoveredSamples_; }

private:
    static constexpr std::int64_t capacity = 1024;

    // Samples are never negative.
    [[nodiscard]] static std::size_t indexOf(std::int64_t sample) noexcept {
        return static_cast<std::size_t>(sample) % static_cast<std::size_t>(capacity);
    }
    [[nodiscard]] float& at(std::int64_t sample) noexcept { return ring_[indexOf(sample)]; }
    [[nodiscard]] float at(std::int64_t sample) const noexcept { return ring_[indexOf(sample)]; }
    void copyIn(std::int64_t start, std::span<const float> samples) noexcept;
    void copyOut(std::int64_t start, std::span<float> out) const noexcept;
    void overwrite(std::int64_t start, std::span<const float> samples) noexcept;
    [[nodiscard]] Continuation continuationFrom(std::int64_t start) const noexcept;

    std::array<float, capacity> ring_{};
    // Starts one segment after 0, so that the past has no negative index.
    std::int64_t head_ = inference::segmentSamples;
    std::int64_t coveredUntil_ = inference::segmentSamples;
    float endGain_ = 1.0F;
    Continuation beforeLastSegment_;
    std::uint64_t uncoveredSamples_ = 0;
};

}  // namespace haptoflow::engine
