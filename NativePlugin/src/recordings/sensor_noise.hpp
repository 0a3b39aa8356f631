#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace haptoflow::recordings {

enum class NoiseSource : std::uint8_t {
    /// No part of the recording shows it, or it is too weak to matter.
    none,
    /// Where the tip rests on the surface or in the air.
    rest,
    /// Where the tip moves so slowly that the level no longer follows the speed.
    quietPart
};

/// "none", "rest" or "quiet part", for reports.
[[nodiscard]] std::string_view nameOf(NoiseSource source);

/// The noise of the accelerometer, which is in every part of a recording alike.
struct SensorNoise {
    NoiseSource source = NoiseSource::none;
    double rmsMps2 = 0.0;
    /// Mean power of each bin of a ShortTimeSpectrum; empty where there is none.
    std::vector<double> power;
};

/// vx, vy in m/s and force in N.
[[nodiscard]] std::array<double, 3> meanMotionOf(std::span<const std::array<float, 3>> motion);

/// Finds the sensor's noise and subtracts its power from the wave's, at every time and frequency, so that level and
/// spectrum are those of the surface. What is far above the noise is not changed, attacks included; where no noise is
/// found, no bit is. The power left is at least a hundredth of what was there.
///
/// wave: 2 kHz, m/s^2. motion: vx, vy in m/s and force in N for each sample. isUsable: 0 where the wave is unknown; it
/// is finite there, too. Throws RecordingUnusable if the recording is no stronger where the tip
/// slides than where it rests.
SensorNoise removeSensorNoise(std::span<float> wave, std::span<const std::array<float, 3>> motion,
                              std::span<const std::uint8_t> isUsable);

}  // namespace haptoflow::recordings
