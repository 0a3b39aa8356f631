#pragma once

#include "dsp/sample_rates.hpp"

#include <cstdint>
#include <span>

namespace haptoflow::dsp {

/// Removes from a 2 kHz waveform what lies below the recordings' band, which begins at 10 Hz: no filter that is fitted
/// to them knows that nothing was there. Butterworth of the second order at 7 Hz: -9.8 dB at 4 Hz, -0.9 dB at 10 Hz,
/// -0.1 dB at 20 Hz; it also removes a constant. Used by one thread; allocates nothing.
class HighPass {
public:
    HighPass() noexcept;

    void process(std::span<float> samples) noexcept;
    /// Forgets the past.
    void reset() noexcept { first_ = second_ = 0.0; }

private:
    double gain_;
    double feedback1_;
    double feedback2_;
    double first_ = 0.0;
    double second_ = 0.0;
};

/// Converts m/s^2 to the output's +-1. The curve is exactly linear up to a knee at 0.7 of the ceiling; above the knee
/// it approaches the ceiling monotonically and never reaches it. It has no memory and adds no delay. Audio thread:
/// allocates nothing, waits for nothing.
class SoftLimiter {
public:
    /// Start of the knee, as a share of the ceiling.
    static constexpr float knee = 0.7F;
    /// At this full scale, less than one sample in a thousand lies above the knee when recorded strokes are rendered
    /// over all labels of the shipped model (Documentation~/devices.md). The C header, C#, Python and
    /// JavaScript repeat the value; a test compares them.
    static constexpr float defaultFullScaleMps2 = 200.0F;

    /// `fullScaleMps2` is the acceleration that the linear part of the curve maps to 1. Throws std::invalid_argument
    /// unless it is finite and above 0.
    explicit SoftLimiter(float fullScaleMps2 = defaultFullScaleMps2);

    /// Sets the limit of the output's magnitude, clamped to 0-1, from the next sample on. Ignores a non-finite value.
    void setCeiling(float ceiling) noexcept;

    /// m/s^2 to shares of full scale, without limit and in place. Counts what is not finite.
    void scale(std::span<float> samples) noexcept;
    /// Limits shares of full scale, of one voice or of a sum, in place. Counts.
    void processScaled(std::span<float> samples) noexcept;
    [[nodiscard]] float ceiling() const noexcept { return ceiling_; }

    /// Number of non-finite samples that `scale` replaced by 0.
    [[nodiscard]] std::uint64_t nonFiniteCount() const noexcept { return nonFiniteCount_; }
    /// Number of samples that `processScaled` found above the knee.
    [[nodiscard]] std::uint64_t limitedCount() const noexcept { return limitedCount_; }

private:
    [[nodiscard]] float bend(float aboveKnee) const noexcept;

    float fullScaleMps2_;
    float ceiling_ = 1.0F;
    float kneeStart_ = knee;
    float largestOutput_;
    std::uint64_t nonFiniteCount_ = 0;
    std::uint64_t limitedCount_ = 0;
};

}  // namespace haptoflow::dsp
