#pragma once

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

namespace haptoflow::headless {

/// Beyond this a coordinate, in metres or seconds, counts as damaged: its square must stay finite.
inline constexpr double largestCoordinate = 1e12;

/// Finite and not beyond `largestCoordinate`.
[[nodiscard]] bool isUsable(double value) noexcept;
[[nodiscard]] bool isUsable(const glm::dvec3& vector) noexcept;

/// `vector` at length 1; `fallback` where it has no direction (zero or not finite). Right from 1e-300 to 1e300.
[[nodiscard]] glm::dvec3 unitOr(const glm::dvec3& vector, const glm::dvec3& fallback) noexcept;

/// `rotation` at length 1; the identity where it is zero or not finite.
[[nodiscard]] glm::dquat unitRotation(const glm::dquat& rotation) noexcept;

/// A unit vector at right angles to `unit`, the same for the same input.
[[nodiscard]] glm::dvec3 anyPerpendicular(const glm::dvec3& unit) noexcept;

}  // namespace haptoflow::headless
