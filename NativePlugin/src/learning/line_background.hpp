#pragma once

#include "learning/path_windows.hpp"

#include <numbers>
#include <span>
#include <vector>

namespace haptoflow::learning {

/// The band in which lines are sought: between the hand's own motion and the end of a recording's band.
inline constexpr double lowestLineHz = 15.0;
inline constexpr double highestLineHz = 800.0;
/// Of the power of noise at one frequency, which is chi-squared with two degrees of freedom, over its mean.
inline constexpr double medianOfNoise = std::numbers::ln2;

/// Divides the power of each window by the mean power of noise at its frequency and speed, estimated from the windows
/// of the most similar speeds: resonances of surface and tool stay at their frequency while the direction changes, and
/// ribs do not. The median over windows and neighbouring frequencies ignores lines.
///
/// `spectra`: a row for each window, whose column c is the wave number c * `cyclesPerMm`.
void divideByBackground(std::span<const PathWindow> windows, double cyclesPerMm,
                        std::vector<std::vector<double>>& spectra);

}  // namespace haptoflow::learning
