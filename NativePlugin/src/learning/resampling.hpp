#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace haptoflow::learning {

/// One channel of interleaved samples, about its mean; what is not finite counts as the mean.
struct Channel {
    const float* first = nullptr;
    std::size_t stride = 1;
    std::size_t count = 0;
    double mean = 0.0;

    [[nodiscard]] double at(std::size_t sample) const {
        const double value = first[sample * stride];
        return std::isfinite(value) ? value - mean : 0.0;
    }
};

/// Samples at 2 kHz of a signal at `rateHz` (1 kHz and more), through a Kaiser-windowed sinc without delay: -6 dB at
/// half of the lower rate, flat to 95 % of it, 66 dB down 5 % above it. Sample 0 stays sample 0; beyond its ends the
/// signal is zero.
[[nodiscard]] std::vector<double> resampledTo2kHz(const Channel& channel, double rateHz);

/// 10 Hz high-pass and 1 kHz low-pass at 2 kHz, the magnitudes of fourth-order Butterworth filters run forward and
/// backward, without phase shift. The ends are reflected.
[[nodiscard]] std::vector<double> bandPassed(std::span<const double> values);

}  // namespace haptoflow::learning
