#pragma once

#include <cstddef>
#include <span>

namespace haptoflow::dsp {

/// How alike two waveforms are over their common length (at most `Splice::correlationSamples`): the normalised
/// cross-correlation clamped to [0, 1]. 1 where either is silent: gains then never exceed 1. Any thread.
[[nodiscard]] double spliceCorrelation(std::span<const float> continuation, std::span<const float> successor) noexcept;

/// The hand-over from a running segment's continuation to its successor within 0-4 samples.
///
/// With progress a and correlation rho the gains are (1 - a) / n and a / n, n = sqrt((1-a)^2 + a^2 + 2 a (1-a) rho):
/// the level holds across the seam for any rho. Identical waveforms pass unchanged, bit for bit.
/// Audio thread: allocates nothing, waits for nothing.
class Splice {
public:
    static constexpr std::size_t maximumLength = 4;
    static constexpr std::size_t correlationSamples = 32;

    /// Starts a splice of `length` samples (clamped to 4, to the continuation and to the successor). Both spans begin
    /// at the seam; only their first 32 samples are looked at, none are kept.
    void begin(std::span<const float> continuation, std::span<const float> successor, std::size_t length) noexcept;
    /// True while `next` still needs the continuation.
    [[nodiscard]] bool active() const noexcept { return index_ < length_; }
    /// The next sample of the seam; the successor's own once the splice is over.
    [[nodiscard]] float next(float continuation, float successor) noexcept;
    /// Drops a splice under way: the successor sounds alone.
    void cancel() noexcept { index_ = length_; }

private:
    double correlation_ = 1.0;
    std::size_t length_ = 0;
    std::size_t index_ = 0;
};

}  // namespace haptoflow::dsp
