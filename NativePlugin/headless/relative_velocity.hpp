#pragma once

#include "headless/tip_path.hpp"

#include <glm/vec3.hpp>

namespace haptoflow::headless {

/// The surface's axes, m/s, of the tip relative to the surface.
struct RelativeVelocity {
    /// At the newest measurement, for what is felt now.
    glm::dvec3 nowMps{0.0};
    /// Mean of the last approachSeconds: how the tip came to where it is, for what it meets there.
    glm::dvec3 approachMps{0.0};
};

/// Velocity of the tip's path over a surface, by GrowingFit. A tip that moves along with a surface has zero velocity,
/// and under a tip at rest a turning surface gives its linear velocity plus angular velocity x arm. If the tracker
/// repeats a position for longer than the hold time, the velocity fades to that of a tip which is held there: zero on a
/// surface at rest. The magnitude is limited to the maximum speed; it is zero with fewer than two measurements.
[[nodiscard]] RelativeVelocity relativeVelocity(const TipPath& path);

}  // namespace haptoflow::headless
