#pragma once

#include "headless/scene.hpp"
#include "headless/tip_history.hpp"

#include <glm/vec3.hpp>

namespace haptoflow::headless {

/// Velocity of the tip relative to the surface's material at `localPoint`, in world axes, m/s: the slope of the
/// straight line through (tip - material point) at the measurements of the last 35 ms, so that a
/// tip riding on a surface reads zero however both move, and a turning surface counts with its linear velocity
/// plus angular velocity x arm. Lag: half the window, 15 to 18 ms at 72 to 120 Hz. While the tracker repeats
/// itself for longer than the hold time, the tip's share fades to zero. Never faster than `fastestMps`; zero
/// with fewer than two measurements.
[[nodiscard]] glm::dvec3 relativeVelocity(const TipHistory& history, const Surface& surface,
                                          const glm::dvec3& localPoint);

}  // namespace haptoflow::headless
