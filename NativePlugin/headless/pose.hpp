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

}  // namespace haptoflow::headless
