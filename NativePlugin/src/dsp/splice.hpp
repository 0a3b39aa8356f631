#pragma once

#include <cstddef>
#include <span>

namespace haptoflow::dsp {

/// Normalised cross-correlation of two waveforms over their common length (at most `Splice::correlationSamples`),
/// clamped to [0, 1]. Returns 1 if either is silent, so that the gains of the splice do not exceed 1. Any thread.
[[nodiscard]] double spliceCorrelation(std::span<const float> continuation, std::span<const float> successor) noexcept;

/// Crossfade of up to 4 samples from the continuation of a running segment to the next segment.
///
/// With progress a and correlation rho, the gains are (1 - a) / n and a / n with n = sqrt((1-a)^2 + a^2 + 2 a (1-a)
/// rho), which keeps the level across the seam for any rho. Identical waveforms pass unchanged, bit for bit. Audio
/// thread: allocates nothing, waits for nothing.
class Splice {
public:
    static constexpr std::size_t maximumLength = 4;
    static constexpr std::size_t correlationSamples = 32;

    /// Starts a splice of `length` samples, limited to 4 and to the length of both spans. Both spans begin at the seam;
    /// their first 32 samples are read and none are kept.
    void begin(std::span<const float> continuation, std::span<const float> successor, std::size_t length) noexcept;
    /// True while `next` still uses the continuation.
    [[nodiscard]] bool active() const noexcept { return index_ < length_; }
    /// The next sample of the seam; after the splice, the successor's sample.
    [[nodiscard]] float next(float continuation, float successor) noexcept;

private:
    double correlation_ = 1.0;
    std::size_t length_ = 0;
    std::size_t index_ = 0;
};

}  // namespace haptoflow::dsp
