#include "engine/contact_publisher.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

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
    EXPECT_EQ(follower.update(ContactState{}, 0.0), ContactAction::rest);
    EXPECT_EQ(follower.update(sliding(0.05F), 0.0), ContactAction::onset);
    EXPECT_EQ(follower.update(sliding(0.05F), 0.0), ContactAction::slide);
    EXPECT_EQ(follower.update(ContactState{.touchCounter = 1}, 0.0), ContactAction::release);
    EXPECT_EQ(follower.update(ContactState{.touchCounter = 1}, 0.0), ContactAction::rest);
}

TEST(ContactFollowerTest, ANewTouchBetweenTwoUpdatesStartsANewOnset) {
    ContactFollower follower;
    EXPECT_EQ(follower.update(sliding(0.05F, 1), 0.0), ContactAction::onset);
    EXPECT_EQ(follower.update(sliding(0.05F, 2), 0.0), ContactAction::onset);
}

TEST(ContactFollowerTest, ATipThatRestsOnTheSurfaceIsSilent) {
    ContactFollower follower;
    EXPECT_EQ(follower.update(sliding(0.0F), 0.0), ContactAction::rest);
    EXPECT_EQ(follower.update(sliding(0.003F), 0.0), ContactAction::rest);
}

TEST(ContactFollowerTest, AroundTheThresholdTheActionDoesNotFlicker) {
    ContactFollower follower;
    EXPECT_EQ(follower.update(sliding(0.0045F), 0.0), ContactAction::onset);
    for (int i = 0; i < 20; ++i) {
        EXPECT_EQ(follower.update(sliding(i % 2 == 0 ? 0.0025F : 0.0045F), 0.0), ContactAction::slide);
    }
    EXPECT_EQ(follower.update(sliding(0.0015F), 0.0), ContactAction::release);
    EXPECT_EQ(follower.update(sliding(0.003F), 0.0), ContactAction::rest);
}

/// A tip on a surface, 90 times a second, with the places that a function of time gives.
class PlacedTip {
public:
    template <typename Place>
    int framesSliding(double seconds, Place&& placeMetres, float speedMps) {
        int frames = 0;
        for (int frame = 0; frame < static_cast<int>(seconds * 90.0); ++frame) {
            now_ += 1.0 / 90.0;
            ContactState state = sliding(speedMps);
            state.hasPlace = 1;
            state.placeMetres = {1.0F + static_cast<float>(placeMetres(static_cast<double>(frame) / 90.0)), 0.5F, 0.0F};
            last_ = follower_.update(state, now_);
            frames += follower_.sliding() ? 1 : 0;
        }
        return frames;
    }
    [[nodiscard]] ContactAction last() const { return last_; }
    [[nodiscard]] bool slides() const { return follower_.sliding(); }

private:
    ContactFollower follower_;
    ContactAction last_ = ContactAction::rest;
    double now_ = 0.0;
};

double tremorMetres(double seconds, double amplitudeMetres) {
    return amplitudeMetres * std::sin(2.0 * std::numbers::pi * 9.0 * seconds);
}

TEST(ContactFollowerPlaceTest, AHeldTipThatTremblesFasterThanItCreepsNeverSlides) {
    for (const double amplitude : {0.00002, 0.0002, 0.00049}) {
        PlacedTip tip;
        const auto speed = static_cast<float>(2.0 * std::numbers::pi * 9.0 * amplitude);
        EXPECT_EQ(tip.framesSliding(
                      20.0, [&](double t) { return tremorMetres(t, amplitude); }, speed),
                  0)
            << amplitude;
    }
}

TEST(ContactFollowerPlaceTest, ACreepingTipSlidesAfterAMillimetreAndGoesOn) {
    for (const double speed : {0.001, 0.002, 0.003, 0.01}) {
        PlacedTip tip;
        const int frames = tip.framesSliding(
            5.0, [&](double t) { return speed * t; }, static_cast<float>(speed));
        EXPECT_NEAR(frames, 450.0 - 90.0 * 0.001 / speed, 3.0) << speed;
    }
}

TEST(ContactFollowerPlaceTest, AStrokeSlidesInItsSecondFrameAndATouchAtSpeedAtOnce) {
    PlacedTip tip;
    (void)tip.framesSliding(
        0.5, [](double) { return 0.0; }, 0.0F);
    EXPECT_EQ(tip.framesSliding(
                  2.01 / 90.0, [](double t) { return 0.1 * t; }, 0.1F),
              1);
    PlacedTip landing;
    EXPECT_EQ(landing.framesSliding(
                  1.01 / 90.0, [](double) { return 0.0; }, 0.1F),
              1);
    PlacedTip resting;
    EXPECT_EQ(resting.framesSliding(
                  1.01 / 90.0, [](double) { return 0.0; }, 0.01F),
              0);
}

TEST(ContactFollowerPlaceTest, AStopEndsSlidingAtOnceAndAStopWithTremorWithinTheHold) {
    PlacedTip tip;
    (void)tip.framesSliding(
        0.5, [](double t) { return 0.1 * t; }, 0.1F);
    ASSERT_TRUE(tip.slides());
    EXPECT_EQ(tip.framesSliding(
                  0.2, [](double) { return 0.049; }, 0.0F),
              0);
    PlacedTip trembling;
    (void)trembling.framesSliding(
        0.5, [](double t) { return 0.1 * t; }, 0.1F);
    const int frames = trembling.framesSliding(
        3.0, [](double t) { return 0.049 + tremorMetres(t, 0.0003); }, 0.017F);
    EXPECT_LE(frames, 0.15 * 90.0 + 4.0);
    EXPECT_FALSE(trembling.slides());
}

TEST(ContactFollowerPlaceTest, AReversalAtTheSpeedOfHandwritingIsOneStroke) {
    for (const double speed : {0.01, 0.027, 0.1, 0.5}) {
        PlacedTip tip;
        (void)tip.framesSliding(
            1.0, [&](double t) { return speed * t; }, static_cast<float>(speed));
        ASSERT_TRUE(tip.slides());
        EXPECT_EQ(tip.framesSliding(
                      1.0, [&](double t) { return speed * (1.0 - t); }, static_cast<float>(speed)),
                  90)
            << speed;
    }
}

}  // namespace
}  // namespace haptoflow::engine
