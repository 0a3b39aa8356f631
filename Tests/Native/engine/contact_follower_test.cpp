#include "engine/contact_follower.hpp"

#include <gtest/gtest.h>

namespace haptoflow::engine {
namespace {

ContactState sliding(float speedMps, std::uint32_t touchCounter = 1) {
    ContactState state;
    state.touching = true;
    state.touchCounter = touchCounter;
    state.velocityMps = {speedMps, 0.0F};
    return state;
}

TEST(ContactFollowerTest, SlidingGivesAnOnsetThenSlidesThenARelease) {
    ContactFollower follower;
    EXPECT_EQ(follower.update(ContactState{}), ContactAction::rest);
    EXPECT_EQ(follower.update(sliding(0.05F)), ContactAction::onset);
    EXPECT_EQ(follower.update(sliding(0.05F)), ContactAction::slide);
    EXPECT_EQ(follower.update(ContactState{.touchCounter = 1}), ContactAction::release);
    EXPECT_EQ(follower.update(ContactState{.touchCounter = 1}), ContactAction::rest);
}

TEST(ContactFollowerTest, ANewTouchBetweenTwoUpdatesStartsANewOnset) {
    ContactFollower follower;
    EXPECT_EQ(follower.update(sliding(0.05F, 1)), ContactAction::onset);
    EXPECT_EQ(follower.update(sliding(0.05F, 2)), ContactAction::onset);
}

TEST(ContactFollowerTest, ATipThatRestsOnTheSurfaceIsSilent) {
    ContactFollower follower;
    EXPECT_EQ(follower.update(sliding(0.0F)), ContactAction::rest);
    EXPECT_EQ(follower.update(sliding(0.003F)), ContactAction::rest);
}

TEST(ContactFollowerTest, AroundTheThresholdTheActionDoesNotFlicker) {
    ContactFollower follower;
    EXPECT_EQ(follower.update(sliding(0.0045F)), ContactAction::onset);
    for (int i = 0; i < 20; ++i) {
        EXPECT_EQ(follower.update(sliding(i % 2 == 0 ? 0.0025F : 0.0045F)), ContactAction::slide);
    }
    EXPECT_EQ(follower.update(sliding(0.0015F)), ContactAction::release);
    EXPECT_EQ(follower.update(sliding(0.003F)), ContactAction::rest);
}

}  // namespace
}  // namespace haptoflow::engine
