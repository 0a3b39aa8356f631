#pragma once

#include "recordings/recording.hpp"
#include "recordings/sensor_noise.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace haptoflow::recordings {

/// A recording in the network's format: one axis at 2 kHz, 10 to 1000 Hz, with the motion at each sample.
struct PreparedRecording {
    /// m/s^2.
    std::vector<float> wave;
    /// vx, vy in m/s and force in N, each the mean over 20 ms.
    std::vector<std::array<float, 3>> motion;
    /// False near samples that were not finite or did not change.
    std::vector<std::uint8_t> isUsable;
    /// Upper end of the recording's band, 475 to 950 Hz.
    double bandwidthHz = 0.0;
    /// What was removed from the wave; never found where the velocity is constant.
    SensorNoise noise;

    [[nodiscard]] double speedMps(std::size_t sample) const;
    /// Of `count` samples from `first` on: vx, vy in m/s and force in N.
    [[nodiscard]] std::array<double, 3> meanMotion(std::size_t first, std::size_t count) const {
        return meanMotionOf(std::span(motion).subspan(first, count));
    }
};

/// The first `maximumSeconds` as one axis at 2 kHz, in m/s^2: resampled (windowed sinc), three axes combined (DFT321),
/// filtered without phase shift.
[[nodiscard]] std::vector<float> combinedWave(const Recording& recording);

/// The combined wave without the sensor's noise, and its motion. Uses the first `maximumSeconds`. Call `checkRecording`
/// first. Throws RecordingUnusable if the recording is nothing but noise.
[[nodiscard]] PreparedRecording prepareRecording(const Recording& recording);

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
/// its ends. Home-made: libsoxr would be one more library to ship with the plugin on every platform.
[[nodiscard]] std::vector<double> resampled(const Channel& channel, double fromHz, double toHz);

/// 10 Hz high-pass and 1 kHz low-pass filter at 2 kHz with the magnitudes of fourth-order Butterworth filters run
/// forward and backward, without phase shift. The ends are reflected.
[[nodiscard]] std::vector<double> bandPassed(std::span<const double> values);

}  // namespace haptoflow::recordings
