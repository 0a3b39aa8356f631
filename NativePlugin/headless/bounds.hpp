#pragma once

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <limits>

namespace haptoflow::headless {

/// An axis-aligned box. It is empty until something is included.
struct Bounds {
    glm::dvec3 lowest{std::numeric_limits<double>::infinity()};
    glm::dvec3 highest{-std::numeric_limits<double>::infinity()};

    void include(const glm::dvec3& point) noexcept {
        lowest = glm::min(lowest, point);
        highest = glm::max(highest, point);
    }
    void include(const Bounds& other) noexcept {
        include(other.lowest);
        include(other.highest);
    }
    /// Squared distance to the nearest point of the box; zero inside.
    [[nodiscard]] double squaredDistanceTo(const glm::dvec3& point) const noexcept {
        const glm::dvec3 offset = point - glm::clamp(point, lowest, highest);
        return glm::dot(offset, offset);
    }
};

}  // namespace haptoflow::headless
