#pragma once

#include <array>
#include <cstddef>

namespace haptoflow::skeleton {

/// vx, vy in m/s along the surface's tangent axes, force in N.
using Motion = std::array<float, 3>;

/// How speed and force enter the networks: ln((speed + 0.5 mm/s) / 60 mm/s) and ln(force + 0.02 N). Negative forces
/// count as 0.
struct LogMotion {
    double speed = 0.0;
    double force = 0.0;
};
[[nodiscard]] LogMotion logMotionOf(const Motion& motion) noexcept;

/// Features that resolve speeds 1 % apart, as a ruled surface needs; and those for levels, which change slowly.
inline constexpr std::size_t fineFeatures = 18;
inline constexpr std::size_t smoothFeatures = 12;

/// Half the logarithms, direction, direction of twice the angle, sine and cosine of harmonics of log speed, speed and a
/// fifth of the force: the training's MotionFeatures (Training/haptoflow_training/models/conditioning.py).
[[nodiscard]] std::array<float, fineFeatures> fineFeaturesOf(const Motion& motion) noexcept;
[[nodiscard]] std::array<float, smoothFeatures> smoothFeaturesOf(const Motion& motion) noexcept;

}  // namespace haptoflow::skeleton
