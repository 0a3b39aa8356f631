#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <span>
#include <vector>

namespace haptoflow::contact {

struct Bounds {
    glm::dvec3 lowest{std::numeric_limits<double>::infinity()};
    glm::dvec3 highest{-std::numeric_limits<double>::infinity()};

    void include(const glm::dvec3& point) noexcept;
    void include(const Bounds& other) noexcept;
    /// Zero inside.
    [[nodiscard]] double squaredDistanceTo(const glm::dvec3& point) const noexcept {
        const glm::dvec3 offset = point - glm::clamp(point, lowest, highest);
        return glm::dot(offset, offset);
    }
};

/// A binary tree of boxes over triangles, split at the median of the longest axis. Visits everything that can be
/// nearest, so that a search through it finds what a search through all triangles finds.
class TriangleBvh {
public:
    explicit TriangleBvh(std::span<const Bounds> triangles);

    /// Calls `consider(triangle)` for triangles near `point`, nearest boxes first. `consider` returns the squared
    /// distance beyond which nothing is of interest any more; boxes farther away than that are left out.
    template <typename Consider>
    void visitNear(const glm::dvec3& point, Consider&& consider) const;

private:
    struct Node {
        Bounds bounds;
        /// Of a leaf: its first entry in order_. Of a branch: its second child; the first follows the branch itself.
        std::uint32_t start = 0;
        std::uint32_t count = 0;
    };
    // A median split halves the count at each level, so 2^32 triangles fit with room to spare.
    static constexpr std::size_t deepest = 64;
    static constexpr std::uint32_t leafSize = 4;

    void build(std::span<const Bounds> triangles, std::uint32_t begin, std::uint32_t end);

    std::vector<Node> nodes_;
    std::vector<std::uint32_t> order_;
};

template <typename Consider>
void TriangleBvh::visitNear(const glm::dvec3& point, Consider&& consider) const {
    double limit = std::numeric_limits<double>::infinity();
    std::array<std::uint32_t, deepest> waiting{};
    std::size_t count = 1;
    while (count > 0) {
        const std::uint32_t index = waiting[--count];
        const Node& node = nodes_[index];
        if (node.bounds.squaredDistanceTo(point) > limit) {
            continue;
        }
        for (std::uint32_t entry = 0; entry < node.count; ++entry) {
            limit = consider(order_[node.start + entry]);
        }
        if (node.count == 0) {
            std::uint32_t near = index + 1;
            std::uint32_t far = node.start;
            if (nodes_[far].bounds.squaredDistanceTo(point) < nodes_[near].bounds.squaredDistanceTo(point)) {
                std::swap(near, far);
            }
            waiting[count++] = far;
            waiting[count++] = near;
        }
    }
}

}  // namespace haptoflow::contact
