#pragma once

#include <cstddef>
#include <vector>

namespace haptoflow::effects {

/// Every `factor`-th sample of a wave behind a low-pass: a sinc under a Kaiser window, 6 dB down at half the new rate,
/// flat to a quarter of it and 50 dB down from three quarters on. Any one thread; allocates in its constructor only.
class WaveDecimation {
public:
    static constexpr std::size_t largestFactor = 96;
    /// The delay of the filter, in samples of the new rate.
    static constexpr std::size_t delaySamples = 3;

    /// 1 to largestFactor; 1 passes every sample on as it is and without delay. Throws std::invalid_argument.
    explicit WaveDecimation(std::size_t factor);

    /// Takes a sample of the old rate, 0 for one that is not finite; true where it completes one of the new rate.
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
