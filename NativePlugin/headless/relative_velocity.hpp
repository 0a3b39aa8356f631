#pragma once

#include "headless/scene.hpp"
#include "headless/tip_history.hpp"

#include <glm/vec3.hpp>

namespace haptoflow::headless {

/// Velocity of the tip relative to the surface's material at `localPoint`, in world axes, m/s: the slope of a straight
/// line through (tip - material point) at the measurements of the last 35 ms. A tip that moves along with a surface
/// therefore has zero velocity, and a turning surface contributes its linear velocity plus angular velocity x arm. The
/// lag is half the window, 15 to 18 ms at 72 to 120 Hz. If the tracker repeats a position for longer than the hold
/// time, the tip's share fades to zero. The magnitude is limited to the maximum speed; it is zero with fewer than two
/// measurements.
[[nodiscard]] glm::dvec3 relativeVelocity(const TipHistory& history, const SceneSurface& surface,
                                          const glm::dvec3& localPoint);

}  // namespace haptoflow::headless
