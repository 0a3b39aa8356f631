// Replaces this program's operator new, so that a test can tell whether a frame of contact allocates.
#include "contact/contact_tracker.hpp"

#include "random_scenes.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

namespace {

std::atomic<std::size_t> allocationCount{0};

void* countedAllocation(std::size_t size) {
    ++allocationCount;
    if (void* memory = std::malloc(size == 0 ? 1 : size)) {
        return memory;
    }
    throw std::bad_alloc();
}

}  // namespace

void* operator new(std::size_t size) {
    return countedAllocation(size);
}
void* operator new[](std::size_t size) {
    return countedAllocation(size);
}
void operator delete(void* memory) noexcept {
    std::free(memory);
}
void operator delete[](void* memory) noexcept {
    std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
    std::free(memory);
}
void operator delete[](void* memory, std::size_t) noexcept {
    std::free(memory);
}

namespace haptoflow::contact {
namespace {

TEST(AllocationTest, NoFrameOfContactAllocatesFromTheFirstOneOn) {
    testing::RandomScenes random(31, 1000, glm::dvec3(0.0));
    const Scene scene = random.scene();
    const std::vector<TipSample> stroke = random.strokeOver(scene, 3000);
    ContactTracker tracker(scene);

    const std::size_t before = allocationCount;
    for (const TipSample& sample : stroke) {
        tracker.update(sample);
    }
    EXPECT_EQ(allocationCount, before);
    EXPECT_GT(tracker.statistics().touchDowns, 20U);
    EXPECT_GT(tracker.statistics().teleports, 5U);

    const std::vector<double> proof(10);
    EXPECT_GT(allocationCount, before) << "the counter does not count";
}

}  // namespace
}  // namespace haptoflow::contact
