#pragma once

#include <cstdint>
#include <span>

namespace haptoflow::dsp {

/// Takes m/s^2 to the output's +-1: exactly linear to a knee at 0.7 of the ceiling, above it a smooth, monotone
/// approach to the ceiling that never gets there, however large the input. Memoryless, so it adds no delay. Audio
/// thread: allocates nothing, waits for nothing.
class SoftLimiter {
public:
    /// Where the knee begins, as a share of the ceiling.
    static constexpr float knee = 0.7F;
    /// People's strokes over all labels of the shipped model leave less than one sample in a thousand above the knee
    /// (Training/results/default/full-scale.json). The header, C#, Python and JavaScript say the same; a test compares.
    static constexpr float defaultFullScaleMps2 = 200.0F;

    /// `fullScaleMps2` is the acceleration that would be 1 without a knee. Throws std::invalid_argument unless it is
    /// finite and above 0.
    explicit SoftLimiter(float fullScaleMps2 = defaultFullScaleMps2);

    /// Largest magnitude of the output, clamped to 0-1, from the next sample on; a non-finite one is ignored.
    void setCeiling(float ceiling) noexcept;

    /// The limited value of one sample; 0 for NaN and infinities, uncounted.
    [[nodiscard]] float limit(float mps2) const noexcept;
    /// Limits in place and counts.
    void process(std::span<float> samples) noexcept;

    /// How many samples `process` has replaced by 0 because they were not finite.
    [[nodiscard]] std::uint64_t nonFiniteCount() const noexcept { return nonFiniteCount_; }
    /// How many samples `process` has bent, that is, found above the knee.
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
