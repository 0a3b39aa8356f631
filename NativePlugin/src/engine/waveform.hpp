#pragma once

#include "engine/mailbox.hpp"
#include "skeleton/stream.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace haptoflow::engine {

/// The waveform of a voice at 2 kHz: a stream plus what a network adds to it. Waveform time counts samples since the
/// voice was opened and advances only by reading.
///
/// A correction takes over at the sample for which it was made and replaces what is left of the one before, across a
/// splice of 4 samples. One that none follows fades over its last 5 ms, and the stream goes on alone. Corrections are
/// in unit scale. The class is a plain value, so that the worker can copy it and
/// read the copy ahead of the callback. Allocates nothing.
class Waveform {
public:
    static constexpr std::int64_t fadeSamples = 10;
    /// A correction must end within this many samples from the head.
    static constexpr std::int64_t aheadSamples = 500;

    /// Begins a stream after silence: see skeleton::Stream::begin. Drops corrections and the past.
    void begin(const skeleton::StreamParameters& parameters, double samplesAhead,
               const skeleton::NoiseKey& key) noexcept;
    /// Goes on with another contact: see skeleton::Stream::follow.
    void follow(const skeleton::StreamParameters& parameters, double samplesAhead) noexcept {
        stream_.follow(parameters, samplesAhead);
    }
    /// Takes a correction. A late one loses the samples that the head has passed. Returns the sample at which it takes
    /// over; -1 if it lies wholly in the past or too far ahead.
    std::int64_t take(const Correction& correction) noexcept;
    /// Says that a correction will take over at `start`, so that one which reaches until there does not fade before.
    void expect(std::int64_t start) noexcept {
        if (start <= correctedUntil_) {
            correctedUntil_ = start + static_cast<std::int64_t>(inference::segmentSamples);
        }
    }
    /// Reads in m/s^2 and advances. `skeleton` is null for a model without one, whose stream is silent.
    void read(const skeleton::Skeleton* skeleton, std::span<float> waveMps2) noexcept;
    /// Writes the 200 samples before the head as they were read; zeros before the beginning.
    void past(std::span<float, inference::segmentSamples> out) const noexcept { copyOut(past_, out); }
    /// The same of the stream alone.
    void ownPast(std::span<float, inference::segmentSamples> out) const noexcept { copyOut(ownPast_, out); }

    /// Number of the next sample to read.
    [[nodiscard]] std::int64_t head() const noexcept { return head_; }
    /// The head at which the present stream began after silence.
    [[nodiscard]] std::int64_t beginning() const noexcept { return beginning_; }
    /// The first sample after the last correction.
    [[nodiscard]] std::int64_t correctedUntil() const noexcept { return correctedUntil_; }
    /// Whether a correction reaches the next sample.
    [[nodiscard]] bool isCorrected() const noexcept { return head_ >= correctedFrom_ && head_ < correctedUntil_; }
    [[nodiscard]] const skeleton::Stream& stream() const noexcept { return stream_; }

private:
    static constexpr std::size_t capacity = 512;
    static_assert(capacity > static_cast<std::size_t>(aheadSamples));

    // Samples are never negative.
    [[nodiscard]] float& correctionAt(std::int64_t sample) noexcept {
        return corrections_[static_cast<std::size_t>(sample) % capacity];
    }
    using Past = std::array<float, inference::segmentSamples>;
    void copyOut(const Past& past, std::span<float, inference::segmentSamples> out) const noexcept;
    void fadeBefore(std::int64_t end) noexcept;
    [[nodiscard]] float nextCorrection() noexcept;

    skeleton::Stream stream_;
    // Zero where no correction is known.
    std::array<float, capacity> corrections_{};
    Past past_{};
    Past ownPast_{};
    // Number of the voice's first sample; any that is not negative would do.
    std::int64_t head_ = inference::segmentSamples;
    std::int64_t beginning_ = inference::segmentSamples;
    std::int64_t correctedFrom_ = inference::segmentSamples;
    std::int64_t correctedUntil_ = inference::segmentSamples;
    float endGain_ = 1.0F;
};

}  // namespace haptoflow::engine
