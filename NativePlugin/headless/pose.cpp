#include "headless/pose.hpp"

#include "headless/vectors.hpp"

namespace haptoflow::headless {

glm::dvec3 Pose::pointToWorld(const glm::dvec3& local) const noexcept {
    return positionMetres + rotation * local;
}

glm::dvec3 Pose::pointToLocal(const glm::dvec3& world) const noexcept {
    return glm::conjugate(rotation) * (world - positionMetres);
}

glm::dvec3 Pose::directionToWorld(const glm::dvec3& local) const noexcept {
    return rotation * local;
}

Pose sanitised(const Pose& pose) noexcept {
    return {isUsable(pose.positionMetres) ? pose.positionMetres : glm::dvec3(0.0), unitRotation(pose.rotation)};
}

}  // namespace haptoflow::headless
