#include "headless/pose.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

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

bool isUsable(double value) noexcept {
    return std::abs(value) <= maximumCoordinate;
}

bool isUsable(const glm::dvec3& vector) noexcept {
    return isUsable(vector.x) && isUsable(vector.y) && isUsable(vector.z);
}

glm::dvec3 unitOr(const glm::dvec3& vector, const glm::dvec3& fallback) noexcept {
    if (!std::isfinite(vector.x) || !std::isfinite(vector.y) || !std::isfinite(vector.z)) {
        return fallback;
    }
    const double largest = std::max({std::abs(vector.x), std::abs(vector.y), std::abs(vector.z)});
    if (!(largest > 1e-300)) {
        return fallback;
    }
    const glm::dvec3 scaled = vector / largest;
    return scaled / std::sqrt(glm::dot(scaled, scaled));
}

glm::dquat unitRotation(const glm::dquat& rotation) noexcept {
    const double largest =
        std::max({std::abs(rotation.x), std::abs(rotation.y), std::abs(rotation.z), std::abs(rotation.w)});
    const double sum = rotation.x + rotation.y + rotation.z + rotation.w;
    if (!std::isfinite(sum) || !(largest > 1e-300)) {
        return {1.0, 0.0, 0.0, 0.0};
    }
    const glm::dquat scaled(rotation.w / largest, rotation.x / largest, rotation.y / largest, rotation.z / largest);
    return scaled / std::sqrt(glm::dot(scaled, scaled));
}

glm::dvec3 anyPerpendicular(const glm::dvec3& unit) noexcept {
    const glm::dvec3 size = glm::abs(unit);
    glm::dvec3 least(0.0, 0.0, 1.0);
    if (size.y <= size.x && size.y <= size.z) {
        least = {0.0, 1.0, 0.0};
    } else if (size.x <= size.z) {
        least = {1.0, 0.0, 0.0};
    }
    return unitOr(least - unit * glm::dot(least, unit), {1.0, 0.0, 0.0});
}

}  // namespace haptoflow::headless
