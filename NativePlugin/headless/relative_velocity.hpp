#pragma once

#include "headless/scene.hpp"
#include "headless/tip_history.hpp"

#include <glm/vec3.hpp>

namespace haptoflow::headless {

/// World axes, m/s, of the tip relative to the surface's material.
struct RelativeVelocity {
    /// At the newest measurement, for what is felt now.
    glm::dvec3 nowMps{0.0};
    /// Mean of the last approachSeconds: how the tip came to where it is, for what it meets there.
    glm::dvec3 approachMps{0.0};
};

/// Velocity relative to the surface's material at `localPoint`, by GrowingFit through (tip - material point). A tip
/// that moves along with a surface therefore has zero velocity, and a turning surface contributes its linear velocity
/// plus angular velocity x arm. If the tracker repeats a position for longer than the hold time, the tip's share fades
/// to zero. The magnitude is limited to the maximum speed; it is zero with fewer than two measurements.
[[nodiscard]] RelativeVelocity relativeVelocity(const TipHistory& history, const SceneSurface& surface,
                                                const glm::dvec3& localPoint);

}  // namespace haptoflow::headless
