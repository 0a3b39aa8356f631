#include "headless/bounds_tree.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace haptoflow::headless {
namespace {

std::vector<std::uint32_t> visited(const BoundsTree& tree, const glm::dvec3& point, double squaredLimit) {
    std::vector<std::uint32_t> items;
    tree.visitNear(point, squaredLimit, [&](std::uint32_t item) {
        items.push_back(item);
        return squaredLimit;
    });
    std::sort(items.begin(), items.end());
    return items;
}

TEST(BoundsTreeTest, EveryBoxWithinTheLimitIsVisitedOnceAndFewOthersAre) {
    std::mt19937 random(29);
    std::uniform_real_distribution<double> spread(-1.0, 1.0);
    const auto anyPoint = [&] { return glm::dvec3(spread(random), spread(random), spread(random)); };
    for (const std::size_t count : {1U, 4U, 5U, 1000U}) {
        std::vector<Bounds> boxes(count);
        for (Bounds& box : boxes) {
            box.include(anyPoint());
            box.include(box.lowest + 0.1 * anyPoint());
        }
        const BoundsTree tree(boxes);
        for (int trial = 0; trial < 300; ++trial) {
            const glm::dvec3 point = anyPoint();
            const double squaredLimit = trial % 2 == 0 ? 0.0 : 0.01;
            const std::vector<std::uint32_t> items = visited(tree, point, squaredLimit);
            EXPECT_EQ(std::adjacent_find(items.begin(), items.end()), items.end());
            for (std::uint32_t item = 0; item < count; ++item) {
                if (boxes[item].squaredDistanceTo(point) <= squaredLimit) {
                    EXPECT_TRUE(std::binary_search(items.begin(), items.end(), item));
                }
            }
            EXPECT_LE(items.size(), 100U);
        }
    }
}

TEST(BoundsTreeTest, IdenticalBoxesAreAllVisited) {
    Bounds box;
    box.include(glm::dvec3(1.0, 2.0, 3.0));
    const std::vector<Bounds> boxes(333, box);
    EXPECT_EQ(visited(BoundsTree(boxes), {1.0, 2.0, 3.0}, 0.0).size(), 333U);
    EXPECT_TRUE(visited(BoundsTree(boxes), {1.0, 2.0, 3.1}, 0.0).empty());
}

TEST(BoundsTreeTest, ATreeWithoutItemsVisitsNone) {
    EXPECT_TRUE(visited(BoundsTree(), glm::dvec3(0.0), 1e300).empty());
    EXPECT_TRUE(visited(BoundsTree(std::vector<Bounds>()), glm::dvec3(0.0), 1e300).empty());
}

}  // namespace
}  // namespace haptoflow::headless
