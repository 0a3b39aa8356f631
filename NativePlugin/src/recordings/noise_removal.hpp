#pragma once

#include "recordings/sensor_noise.hpp"

#include <array>
#include <cstdint>
#include <span>

namespace haptoflow::recordings {

/// Finds the sensor's noise and subtracts its power from the wave's, at every time and frequency, so that level and
/// spectrum are those of the surface. What is far above the noise is not changed, attacks included; where no noise is
/// found, no bit is. The power left is at least a hundredth of what was there.
///
/// wave: 2 kHz, m/s^2. motion: vx, vy in m/s and force in N for each sample. isUsable: 0 where the wave is unknown; it
/// is finite there, too. Throws as findSensorNoise does.
SensorNoise removeSensorNoise(std::span<float> wave, std::span<const std::array<float, 3>> motion,
                              std::span<const std::uint8_t> isUsable);

}  // namespace haptoflow::recordings
