#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <span>
#include <utility>
#include <vector>

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

/// A bounding volume hierarchy: a binary tree of boxes over items (the triangles of a mesh, the surfaces of a scene),
/// split at the median of the longest axis. Items are identified by their index in `items`. A search visits every item
/// whose box is within the limit, so that it finds the same item as a search through all of them.
class BoundsTree {
public:
    /// A tree without items.
    BoundsTree() = default;
    /// All boxes must be finite.
    explicit BoundsTree(std::span<const Bounds> items);

    /// Calls `consider(item)` for items near `point`, in the order of their boxes' distances, and for some that lie
    /// farther away. `consider` returns the squared distance beyond which items are no longer of interest; boxes
    /// farther away than that, or than `squaredLimit` at the start, are skipped.
    template <typename Consider>
    void visitNear(const glm::dvec3& point, double squaredLimit, Consider&& consider) const;

private:
    struct Node {
        Bounds bounds;
        /// For a leaf, its first entry in order_. For a branch, its second child; the first child follows the branch
        /// itself.
        std::uint32_t start = 0;
        std::uint32_t count = 0;
    };
    // A median split halves the number of items at each level, so that 2^32 items need 32 levels.
    static constexpr std::size_t maximumDepth = 64;
    static constexpr std::uint32_t leafSize = 4;

    void build(std::span<const Bounds> items, std::uint32_t begin, std::uint32_t end);

    std::vector<Node> nodes_;
    std::vector<std::uint32_t> order_;
};

template <typename Consider>
void BoundsTree::visitNear(const glm::dvec3& point, double squaredLimit, Consider&& consider) const {
    double limit = squaredLimit;
    std::array<std::uint32_t, maximumDepth> waiting{};
    std::size_t count = nodes_.empty() ? 0 : 1;
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
            std::uint32_t nearer = index + 1;
            std::uint32_t farther = node.start;
            if (nodes_[farther].bounds.squaredDistanceTo(point) < nodes_[nearer].bounds.squaredDistanceTo(point)) {
                std::swap(nearer, farther);
            }
            waiting[count++] = farther;
            waiting[count++] = nearer;
        }
    }
}

}  // namespace haptoflow::headless
