#pragma once

#include "dsp/splice.hpp"
#include "inference/segment_generator.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace haptoflow::engine {

/// The first samples of the wave that would have gone on from `start` if no segment had taken over there: what a splice
/// fades out of.
struct Continuation {
    /// -1: no segment has taken over anywhere.
    std::int64_t start = -1;
    std::size_t count = 0;
    std::array<float, dsp::Splice::correlationSamples> samplesMps2{};

    [[nodiscard]] std::span<const float> known() const noexcept { return std::span(samplesMps2).first(count); }
};

/// What is committed of a timeline, for another thread to plan with.
struct TimelineView {
    /// Room for the past, and for what may be committed ahead of the head.
    static constexpr std::size_t pastSamples = inference::segmentSamples;
    static constexpr std::size_t aheadSamples = 3 * inference::segmentSamples;

    std::int64_t head = 0;
    std::int64_t coveredUntil = 0;
    Continuation beforeLastSegment;
    /// Samples from head - pastSamples to coveredUntil, m/s^2.
    std::array<float, pastSamples + aheadSamples> samplesMps2{};
};

/// One voice's waveform in waveform time: 2 kHz samples since the voice opened, advanced by reading and nothing else.
///
/// Committed are the samples from 200 behind the head to `coveredUntil()`. A segment takes over at the sample that it
/// was generated for; what the running one still had behind it is discarded (the paper's overwriting buffer).
/// Allocates nothing; one thread.
class WaveformTimeline {
public:
    static constexpr std::size_t seedSamples = model::seedSamples;

    /// Touch-down: 200 samples of `seed` (400, m/s^2) become the past unplayed, 200 follow from the head on. Where an
    /// earlier touch still has samples there, a splice hands over.
    void open(std::span<const float, seedSamples> seedMps2) noexcept;
    /// `segment` (200, m/s^2) takes over at `start` and is spliced with the wave that ran there before. It replaces a
    /// segment that took over at the same sample if nothing of that one has been read: the splice is then made with the
    /// wave before both. A segment that comes late loses the samples that the head has passed. One that lies wholly in
    /// the past, would leave a hole, or reaches further than a view changes nothing. Returns the sample at which the
    /// segment took over, or -1.
    std::int64_t commit(std::int64_t start, std::span<const float, inference::segmentSamples> segment) noexcept;
    /// The 200 committed samples before `start`; zeros where none were committed. `start` within 200 of the head.
    void history(std::int64_t start, std::span<float, inference::segmentSamples> out) const noexcept;
    /// Reads and advances. Beyond the last committed sample it reads zeros; the last 5 ms before that point fade.
    void read(std::span<float> out) noexcept;
    /// Drops everything that was not read; the clock goes on.
    void clear() noexcept;

    /// Writes what is committed, as far as the view reaches.
    void view(TimelineView& out) const noexcept;
    /// Becomes the timeline that was viewed, as far as histories and commits can tell.
    void restore(const TimelineView& from) noexcept;

    /// The next sample to be read.
    [[nodiscard]] std::int64_t head() const noexcept { return head_; }
    /// The first sample that no segment covers.
    [[nodiscard]] std::int64_t coveredUntil() const noexcept { return coveredUntil_; }
    /// Samples read for which no segment was there.
    [[nodiscard]] std::uint64_t uncoveredSamples() const noexcept { return uncoveredSamples_; }

private:
    static constexpr std::int64_t capacity = 1024;

    // Samples are never negative, and the capacity is a power of two.
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
    // Starts where a whole past fits before it, so that no index is negative.
    std::int64_t head_ = inference::segmentSamples;
    std::int64_t coveredUntil_ = inference::segmentSamples;
    float endGain_ = 1.0F;
    Continuation beforeLastSegment_;
    std::uint64_t uncoveredSamples_ = 0;
};

}  // namespace haptoflow::engine
