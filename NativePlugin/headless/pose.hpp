#pragma once

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

namespace haptoflow::headless {

/// Position in metres and rotation of an object, in Unity's left-handed, y-up frame.
struct Pose {
    glm::dvec3 positionMetres{0.0};
    glm::dquat rotation{1.0, 0.0, 0.0, 0.0};

    [[nodiscard]] glm::dvec3 pointToWorld(const glm::dvec3& local) const noexcept;
    [[nodiscard]] glm::dvec3 pointToLocal(const glm::dvec3& world) const noexcept;
    [[nodiscard]] glm::dvec3 directionToWorld(const glm::dvec3& local) const noexcept;
};

/// The same pose with a unit rotation and usable numbers: an unusable position becomes the origin, an unusable rotation
/// the identity.
[[nodiscard]] Pose sanitised(const Pose& pose) noexcept;

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
