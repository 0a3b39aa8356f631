#pragma once

#include <cstddef>
#include <vector>

namespace haptoflow::effects {

/// Low-pass filters a wave and keeps every `factor`-th sample. The filter is a Kaiser-windowed sinc: flat to a quarter
/// of the new rate, -6 dB at half of it, -50 dB from three quarters on. Used by one thread at a time; only the
/// constructor allocates.
class WaveDecimation {
public:
    static constexpr std::size_t maximumFactor = 96;
    /// Delay of the filter in samples of the new rate.
    static constexpr std::size_t delaySamples = 3;

    /// `factor` is 1 to maximumFactor; 1 passes every sample unchanged and without delay. Throws std::invalid_argument.
    explicit WaveDecimation(std::size_t factor);

    /// Takes a sample at the old rate; a non-finite one counts as 0. Returns true if it completes a sample at the new
    /// rate, and then writes that to `decimated`.
    [[nodiscard]] bool take(float sample, float& decimated) noexcept;
    void reset() noexcept;

private:
    std::size_t factor_;
    std::vector<float> kernel_;
    std::vector<float> newest_;
    std::size_t place_ = 0;
    std::size_t untilNext_;
};

}  // namespace haptoflow::effects
