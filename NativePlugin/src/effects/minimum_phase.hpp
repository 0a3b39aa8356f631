#pragma once

#include <span>
#include <vector>

namespace haptoflow::effects {

/// The phase, in radians, of the minimum-phase system whose natural log magnitude is `logMagnitude` at frequencies
/// `octavesPerPoint` apart; beyond the ends the magnitude stays the end's. One value a point. Allocates.
[[nodiscard]] std::vector<double> minimumPhaseRadians(std::span<const double> logMagnitude, double octavesPerPoint);

}  // namespace haptoflow::effects
