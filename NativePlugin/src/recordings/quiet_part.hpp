#pragma once

#include "recordings/frame_motion.hpp"
#include "recordings/short_time_spectrum.hpp"

#include <optional>
#include <span>
#include <vector>

namespace haptoflow::recordings {

/// The mean power of the sensor's noise in each bin, found where the tip is slower than 15 mm/s. A straight line is
/// fitted to the power over speed^1.2, and its value at speed zero is the noise. The power of every label grows at
/// least as fast as speed^1.2, so that the line never takes a part of the texture for noise.
///
/// None unless that is most of what is there, steady, below 0.1 m/s^2 and far below the level of fast strokes: a
/// texture must never be taken for noise.
[[nodiscard]] std::optional<std::vector<double>> noiseOfQuietPart(const SpectrumCells& power,
                                                                  std::span<const FrameMotion> motion);

}  // namespace haptoflow::recordings
