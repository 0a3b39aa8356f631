#include "headless/contact_tracker.hpp"

#include "test_scenes.hpp"

#include <gtest/gtest.h>

#include <random>
#include <stdexcept>

namespace haptoflow::headless {
namespace {

using testing::play;
using testing::sampledPath;
using testing::sceneOf;
using testing::speedOf;
using testing::surfaceOf;

/// Position of the centre of a 1 mm tip that is pressed `depth` into a table at y = 0.
glm::dvec3 pressed(double depth, double x = 0.0) {
    return {x, 0.001 - depth, 0.0};
}

TEST(ContactTrackerTest, TouchBeginsAtPenetrationAndEndsBeyondTheReleaseDistance) {
    ContactTracker tracker(sceneOf({surfaceOf(Plane{})}));
    auto touchingAt = [&, time = 0.0](double depth) mutable {
        time += 0.01;
        return tracker.update({time, pressed(depth), {}, {}}).touching;
    };
    EXPECT_FALSE(touchingAt(-0.0003));
    EXPECT_FALSE(touchingAt(0.0));
    EXPECT_TRUE(touchingAt(0.0001));
    EXPECT_TRUE(touchingAt(-0.0004));
    EXPECT_FALSE(touchingAt(-0.0006));
    EXPECT_FALSE(touchingAt(-0.0004));
}

TEST(ContactTrackerTest, TouchCounterGrowsAtEachTouchDownOnly) {
    ContactTracker tracker(sceneOf({surfaceOf(Plane{})}));
    const auto readings = play(tracker, sampledPath(2.0, 90.0, [](double time) {
                                   return pressed(0.002 * std::sin(2.0 * std::numbers::pi * 2.0 * time), 0.1 * time);
                               }));
    EXPECT_EQ(readings.back().touchCounter, 4U);
    EXPECT_EQ(tracker.statistics().touchDowns, 4U);
    for (std::size_t frame = 1; frame < readings.size(); ++frame) {
        const bool down = readings[frame].touching && !readings[frame - 1].touching;
        EXPECT_EQ(readings[frame].touchCounter - readings[frame - 1].touchCounter, down ? 1U : 0U);
    }
}

TEST(ContactTrackerTest, SpringForceIsStiffnessTimesDepthUpToTheMaximum) {
    Scene scene = sceneOf({surfaceOf(Plane{})});
    scene.surfaces[0].stiffnessNewtonsPerMetre = 800.0;
    ContactTracker tracker(scene);
    EXPECT_NEAR(tracker.update({0.0, pressed(0.002), {}, {}}).forceNewtons, 1.6, 1e-12);
    EXPECT_DOUBLE_EQ(tracker.update({0.01, pressed(0.5), {}, {}}).forceNewtons, 5.0);
    EXPECT_DOUBLE_EQ(tracker.update({0.02, pressed(-0.0002), {}, {}}).forceNewtons, 0.0);
}

TEST(ContactTrackerTest, AMeasuredForceReplacesTheSpringForceWhileTouching) {
    ContactTracker tracker(sceneOf({surfaceOf(Plane{})}));
    EXPECT_DOUBLE_EQ(tracker.update({0.00, pressed(0.002), 0.7, {}}).forceNewtons, 0.7);
    EXPECT_DOUBLE_EQ(tracker.update({0.01, pressed(0.002), 70.0, {}}).forceNewtons, 5.0);
    EXPECT_DOUBLE_EQ(tracker.update({0.02, pressed(0.002), -1.0, {}}).forceNewtons, 0.0);
    EXPECT_DOUBLE_EQ(tracker.update({0.03, pressed(-0.1), 0.7, {}}).forceNewtons, 0.0);
    EXPECT_NEAR(tracker.update({0.04, pressed(0.002), {}, {}}).forceNewtons, 1.0, 1e-12);
}

TEST(ContactTrackerTest, StiffnessComesFromTheSurfaceThenItsLabelsThenTheDefault) {
    Scene scene = sceneOf({surfaceOf(Plane{})});
    ContactSettings settings;
    settings.defaultStiffnessNewtonsPerMetre = 300.0;
    settings.stiffnessOfLabel = [](std::string_view label) -> std::optional<double> {
        return label == "wood" ? std::optional(1000.0) : label == "cork" ? std::optional(500.0) : std::nullopt;
    };
    const auto forceOf = [&] {
        return ContactTracker(scene, settings).update({0.0, pressed(0.001), {}, {}}).forceNewtons;
    };
    scene.surfaces[0].material = {{"wood", 0.25}, {"cork", 0.75}};
    EXPECT_NEAR(forceOf(), 0.625, 1e-12);
    scene.surfaces[0].material = {{"wood", 0.5}, {"unknown", 0.5}};
    EXPECT_NEAR(forceOf(), 1.0, 1e-12);
    scene.surfaces[0].material = {{"unknown", 1.0}};
    EXPECT_NEAR(forceOf(), 0.3, 1e-12);
    scene.surfaces[0].stiffnessNewtonsPerMetre = 2000.0;
    EXPECT_NEAR(forceOf(), 2.0, 1e-12);
}

TEST(ContactTrackerTest, VelocityIsSplitAlongTheTwoTangentAxes) {
    ContactTracker tracker(sceneOf({surfaceOf(Plane{})}));
    const auto readings =
        play(tracker, sampledPath(0.3, 90.0, [](double time) { return glm::dvec3(0.2 * time, 0.0, 0.1 * time); }));
    EXPECT_NEAR(readings.back().tangentialVelocityMps.x, 0.2, 1e-9);
    EXPECT_NEAR(readings.back().tangentialVelocityMps.y, -0.1, 1e-9);
}

TEST(ContactTrackerTest, TheGrainTurnsWithTheObject) {
    SceneSurface plate = surfaceOf(Plane{}, {{0.0, 0.0, 0.0}, testing::turned(90.0, {0.0, 1.0, 0.0})});
    ContactTracker tracker(sceneOf({plate}));
    // Unity turns +x towards -z about +y: the grain points along -z now.
    const auto readings =
        play(tracker, sampledPath(0.3, 90.0, [](double time) { return glm::dvec3(0.0, 0.0, -0.2 * time); }));
    EXPECT_NEAR(readings.back().tangentialVelocityMps.x, 0.2, 1e-9);
    EXPECT_NEAR(readings.back().tangentialVelocityMps.y, 0.0, 1e-9);
}

TEST(ContactTrackerTest, AStrokeOnATurningObjectKeepsItsAxes) {
    SceneSurface plate = surfaceOf(Plane{});
    plate.motion.emplace(std::vector<Keyframe>{{0.0, {{}, testing::turned(0.0, {1.0, 2.0, 0.5})}},
                                               {1.0, {{0.3, 0.2, 0.1}, testing::turned(150.0, {1.0, 2.0, 0.5})}}},
                         false);
    ContactTracker tracker(sceneOf({plate}));
    const auto readings = play(tracker, sampledPath(1.0, 90.0, [&](double time) {
                                   return plate.poseAt(time).pointToWorld({0.2 * time, 0.0, 0.1 * time});
                               }));
    for (std::size_t frame = 5; frame < readings.size(); ++frame) {
        // During the lag of half a window the plate turns by 2.6 degrees.
        EXPECT_NEAR(readings[frame].tangentialVelocityMps.x, 0.2, 0.02);
        EXPECT_NEAR(readings[frame].tangentialVelocityMps.y, -0.1, 0.02);
    }
}

TEST(ContactTrackerTest, ApproachSpeedIsConstantDuringATouch) {
    ContactTracker tracker(sceneOf({surfaceOf(Plane{})}));
    const auto readings = play(tracker, sampledPath(0.6, 120.0, [](double time) {
                                   return glm::dvec3(0.05 * time, std::max(0.0, 0.05 - 0.4 * time), 0.0);
                               }));
    const auto down =
        std::find_if(readings.begin(), readings.end(), [](const auto& reading) { return reading.touching; });
    ASSERT_NE(down, readings.end());
    EXPECT_NEAR(down->approachSpeedMps, 0.4, 0.01);
    EXPECT_DOUBLE_EQ(readings.front().approachSpeedMps, 0.0);
    EXPECT_DOUBLE_EQ(readings.back().approachSpeedMps, down->approachSpeedMps);
}

TEST(ContactTrackerTest, TheDeepestContactWinsUntilAnotherIsDeeperByTheMargin) {
    const SceneSurface left = surfaceOf(Box{{0.1, 0.1, 0.1}}, {{-0.05, -0.05, 0.0}, {1.0, 0.0, 0.0, 0.0}});
    SceneSurface right = surfaceOf(Box{{0.1, 0.1, 0.1}}, {{0.05, -0.0497, 0.0}, {1.0, 0.0, 0.0, 0.0}});
    ContactTracker tracker(sceneOf({left, right}));
    EXPECT_EQ(tracker.update({0.00, pressed(0.0005, -0.02), {}, {}}).surfaceIndex, 0);
    EXPECT_EQ(tracker.update({0.01, pressed(0.0005, -0.0002), {}, {}}).surfaceIndex, 0);
    EXPECT_EQ(tracker.update({0.02, pressed(0.0005, 0.02), {}, {}}).surfaceIndex, 1);
    EXPECT_EQ(tracker.update({0.03, pressed(0.0005, 0.0002), {}, {}}).surfaceIndex, 1);
    EXPECT_EQ(tracker.update({0.04, pressed(0.0005, 0.0002), {}, {}}).touchCounter, 1U);
}

TEST(ContactTrackerTest, JitterOnTheSeamOfTwoSurfacesDoesNotSwitchBackAndForth) {
    const SceneSurface left = surfaceOf(Box{{0.1, 0.1, 0.1}}, {{-0.05, -0.05, 0.0}, {1.0, 0.0, 0.0, 0.0}});
    const SceneSurface right = surfaceOf(Box{{0.1, 0.1, 0.1}}, {{0.05, -0.05, 0.0}, {1.0, 0.0, 0.0, 0.0}});
    ContactTracker tracker(sceneOf({left, right}));
    const auto readings = play(tracker, sampledPath(2.0, 90.0, [frame = 0](double) mutable {
                                   return pressed(0.0007, ++frame % 2 == 0 ? 0.0004 : -0.0004);
                               }));
    for (const ContactReading& reading : readings) {
        EXPECT_EQ(reading.surfaceIndex, readings.front().surfaceIndex);
    }
}

TEST(ContactTrackerTest, CrossingABoxEdgeRollsTheNormalOverInsteadOfFlippingIt) {
    ContactTracker tracker(sceneOf({surfaceOf(Box{{0.1, 0.1, 0.1}})}, 0.005));
    // Over the top, around the edge at a depth of 0.5 mm, down the side.
    const auto readings = play(tracker, sampledPath(1.0, 240.0, [](double time) {
                                   const double path = 0.04 * time - 0.02;
                                   const double arc = 0.0045 * std::numbers::pi / 2.0;
                                   const double angle = std::clamp(path / 0.0045, 0.0, std::numbers::pi / 2.0);
                                   return glm::dvec3(0.05 + std::min(0.0, path) + 0.0045 * std::sin(angle),
                                                     0.05 + 0.0045 * std::cos(angle) - std::max(0.0, path - arc), 0.0);
                               }));
    for (std::size_t frame = 1; frame < readings.size(); ++frame) {
        ASSERT_TRUE(readings[frame].touching);
        EXPECT_LT(testing::degreesBetween(readings[frame].normal, readings[frame - 1].normal), 2.5);
    }
    EXPECT_NEAR(readings.front().normal.y, 1.0, 1e-12);
    EXPECT_NEAR(readings.back().normal.x, 1.0, 1e-12);
}

TEST(ContactTrackerTest, RandomStrokesOverAMovingBoxHaveNoStrayVelocity) {
    std::mt19937 random(6);
    std::normal_distribution<double> gaussian;
    SceneSurface box = surfaceOf(Box{{0.2, 0.1, 0.15}}, {{0.1, 0.2, 0.3}, testing::turned(40.0, {1.0, 1.0, 0.0})});
    ContactTracker tracker(sceneOf({box}, 0.004));
    glm::dvec3 position(0.0, 0.053, 0.0);
    glm::dvec3 velocity(0.2, 0.0, 0.1);
    double lastSpeed = 0.0;
    for (int frame = 0; frame < 5000; ++frame) {
        velocity += 0.02 * glm::dvec3(gaussian(random), gaussian(random), gaussian(random)) - 0.02 * velocity -
                    0.3 * (position - glm::clamp(position, glm::dvec3(-0.1), glm::dvec3(0.1)));
        position += velocity / 90.0;
        const ContactReading reading =
            tracker.update({frame / 90.0, box.pose.pointToWorld(position), std::nullopt, std::nullopt});
        EXPECT_TRUE(testing::isSane(reading));
        lastSpeed = std::max(lastSpeed * 0.97, glm::length(velocity));
        EXPECT_LT(speedOf(reading), lastSpeed + 0.1);
    }
    EXPECT_GT(tracker.statistics().touchDowns, 3U);
}

TEST(ContactTrackerTest, SurfacesFarFromTheTipAreRuledOutByTheirBoundingSphere) {
    ContactTracker tracker(
        sceneOf({surfaceOf(Sphere{0.1}), surfaceOf(Sphere{0.1}, {{5.0, 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0}})}));
    tracker.update({0.0, {0.0, 0.1, 0.0}, {}, {}});
    EXPECT_EQ(tracker.statistics().surfaceQueries, 1U);
    EXPECT_EQ(tracker.statistics().surfacesRuledOut, 1U);
}

TEST(ContactTrackerTest, SettingsAndShapesOutOfRangeAreRefused) {
    const Scene scene = sceneOf({surfaceOf(Plane{})});
    ContactSettings settings;
    settings.maximumForceNewtons = 0.0;
    EXPECT_THROW(ContactTracker(scene, settings), std::invalid_argument);
    settings = {};
    settings.velocity.stopSeconds = settings.velocity.holdSeconds;
    EXPECT_THROW(ContactTracker(scene, settings), std::invalid_argument);
    EXPECT_THROW(ContactTracker(sceneOf({surfaceOf(Plane{})}, -1.0)), std::invalid_argument);
    EXPECT_THROW(ContactTracker(sceneOf({surfaceOf(Box{{1.0, 0.0, 1.0}})})), std::invalid_argument);
    EXPECT_THROW(ContactTracker(sceneOf({surfaceOf(std::shared_ptr<const TriangleMesh>())})), std::invalid_argument);
}

}  // namespace
}  // namespace haptoflow::headless
