#include "headless/contact_tracker.hpp"

#include "random_scenes.hpp"
#include "support/counting_new.hpp"

#include <gtest/gtest.h>

namespace haptoflow::headless {
namespace {

TEST(AllocationTest, NoFrameOfContactAllocates) {
    testing::RandomScenes random(31, 1000, glm::dvec3(0.0));
    const Scene scene = random.scene();
    const std::vector<TipSample> stroke = random.strokeOver(scene, 3000);
    ContactTracker tracker(scene);

    const std::size_t before = haptoflow::testing::allocationCount();
    for (const TipSample& sample : stroke) {
        tracker.update(sample);
    }
    EXPECT_EQ(haptoflow::testing::allocationCount(), before);
    EXPECT_GT(tracker.statistics().touchDowns, 20U);
    EXPECT_GT(tracker.statistics().teleports, 5U);

    const std::vector<double> proof(10);
    EXPECT_GT(haptoflow::testing::allocationCount(), before) << "the counter does not work";
}

}  // namespace
}  // namespace haptoflow::headless
