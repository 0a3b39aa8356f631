#include "contact/triangle_bvh.hpp"

#include <algorithm>
#include <numeric>

namespace haptoflow::contact {

void Bounds::include(const glm::dvec3& point) noexcept {
    lowest = glm::min(lowest, point);
    highest = glm::max(highest, point);
}

void Bounds::include(const Bounds& other) noexcept {
    include(other.lowest);
    include(other.highest);
}

TriangleBvh::TriangleBvh(std::span<const Bounds> triangles) : order_(triangles.size()) {
    std::iota(order_.begin(), order_.end(), 0U);
    nodes_.reserve(triangles.size());
    build(triangles, 0, static_cast<std::uint32_t>(triangles.size()));
}

void TriangleBvh::build(std::span<const Bounds> triangles, std::uint32_t begin, std::uint32_t end) {
    Bounds all;
    Bounds centres;
    for (std::uint32_t entry = begin; entry < end; ++entry) {
        const Bounds& bounds = triangles[order_[entry]];
        all.include(bounds);
        centres.include(0.5 * (bounds.lowest + bounds.highest));
    }
    const std::size_t index = nodes_.size();
    nodes_.push_back({all, begin, end - begin});
    if (end - begin <= leafSize) {
        return;
    }
    const glm::dvec3 extent = centres.highest - centres.lowest;
    glm::length_t axis = extent.y > extent.x ? 1 : 0;
    if (extent.z > extent[axis]) {
        axis = 2;
    }
    const std::uint32_t middle = begin + (end - begin) / 2;
    std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                     [&](std::uint32_t a, std::uint32_t b) {
                         return triangles[a].lowest[axis] + triangles[a].highest[axis] <
                                triangles[b].lowest[axis] + triangles[b].highest[axis];
                     });
    build(triangles, begin, middle);
    nodes_[index].start = static_cast<std::uint32_t>(nodes_.size());
    nodes_[index].count = 0;
    build(triangles, middle, end);
}

}  // namespace haptoflow::contact
