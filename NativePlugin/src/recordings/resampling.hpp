#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace haptoflow::recordings {

/// One channel of interleaved samples without its mean; samples that are not finite count as the mean.
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

/// Resamples a signal from one rate to another, both 1 kHz or more, with a Kaiser-windowed sinc without delay: -6 dB at
/// half of the lower rate, flat to 95 % of it, -66 dB 5 % above it. Sample 0 stays sample 0; the signal is zero beyond
/// its ends. Home-made: libsoxr would be one more library to ship with the plugin on every platform (the tests of dsp
/// compare with it).
[[nodiscard]] std::vector<double> resampled(const Channel& channel, double fromHz, double toHz);

/// 10 Hz high-pass and 1 kHz low-pass filter at 2 kHz with the magnitudes of fourth-order Butterworth filters run
/// forward and backward, without phase shift. The ends are reflected.
[[nodiscard]] std::vector<double> bandPassed(std::span<const double> values);

}  // namespace haptoflow::recordings
