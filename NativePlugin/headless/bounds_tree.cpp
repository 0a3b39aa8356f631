#include "headless/bounds_tree.hpp"

#include <algorithm>
#include <numeric>

namespace haptoflow::headless {

BoundsTree::BoundsTree(std::span<const Bounds> items) : order_(items.size()) {
    std::iota(order_.begin(), order_.end(), 0U);
    if (!items.empty()) {
        nodes_.reserve(items.size());
        build(items, 0, static_cast<std::uint32_t>(items.size()));
    }
}

void BoundsTree::build(std::span<const Bounds> items, std::uint32_t begin, std::uint32_t end) {
    Bounds all;
    Bounds centres;
    for (std::uint32_t entry = begin; entry < end; ++entry) {
        const Bounds& bounds = items[order_[entry]];
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
    const auto at = [this](std::uint32_t place) { return order_.begin() + static_cast<std::ptrdiff_t>(place); };
    std::nth_element(at(begin), at(middle), at(end), [&](std::uint32_t a, std::uint32_t b) {
        return items[a].lowest[axis] + items[a].highest[axis] < items[b].lowest[axis] + items[b].highest[axis];
    });
    build(items, begin, middle);
    nodes_[index].start = static_cast<std::uint32_t>(nodes_.size());
    nodes_[index].count = 0;
    build(items, middle, end);
}

}  // namespace haptoflow::headless
