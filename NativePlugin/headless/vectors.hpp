#pragma once

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

namespace haptoflow::headless {

/// Coordinates beyond this, in metres or seconds, are not usable: their squares must stay finite.
inline constexpr double maximumCoordinate = 1e12;

/// True for a finite number of at most `maximumCoordinate`.
[[nodiscard]] bool isUsable(double value) noexcept;
[[nodiscard]] bool isUsable(const glm::dvec3& vector) noexcept;

/// `vector` normalised; `fallback` if it has no direction (zero or not finite). Accurate from 1e-300 to 1e300.
[[nodiscard]] glm::dvec3 unitOr(const glm::dvec3& vector, const glm::dvec3& fallback) noexcept;

/// `rotation` normalised; the identity if it is zero or not finite.
[[nodiscard]] glm::dquat unitRotation(const glm::dquat& rotation) noexcept;

/// A unit vector perpendicular to `unit`; the same for the same input.
[[nodiscard]] glm::dvec3 anyPerpendicular(const glm::dvec3& unit) noexcept;

}  // namespace haptoflow::headless
