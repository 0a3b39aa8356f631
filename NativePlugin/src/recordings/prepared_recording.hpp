#pragma once

#include "recordings/recording.hpp"
#include "recordings/sensor_noise.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
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
    [[nodiscard]] std::array<double, 3> meanMotion(std::size_t first, std::size_t count) const;
};

/// The first `maximumSeconds` as one axis at 2 kHz, in m/s^2: resampled (windowed sinc), three axes combined (DFT321),
/// filtered without phase shift.
[[nodiscard]] std::vector<float> combinedWave(const Recording& recording);

/// The combined wave without the sensor's noise, and its motion. Uses the first `maximumSeconds`. Call `checkRecording`
/// first. Throws RecordingUnusable if the recording is nothing but noise.
[[nodiscard]] PreparedRecording prepareRecording(const Recording& recording);

}  // namespace haptoflow::recordings
