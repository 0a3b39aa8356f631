#include "headless/contact_tracker.hpp"

#include "test_scenes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <iterator>
#include <numbers>
#include <random>
#include <utility>

namespace haptoflow::headless {
namespace {

using testing::isSane;
using testing::play;
using testing::sampledPath;
using testing::sceneOf;
using testing::speedOf;
using testing::surfaceOf;
using testing::turned;

/// A plate at an oblique angle in the world, with a grain. A tip of 4 mm is drawn over its upper face, 1 mm deep.
SceneSurface plate() {
    SceneSurface surface = surfaceOf(Box{{40.0, 0.02, 40.0}}, {{0.3, -0.2, 0.1}, turned(35.0, {1.0, 2.0, -1.0})});
    surface.grain = {3.0, 0.0, 4.0};
    return surface;
}

glm::dvec3 onPlate(const Pose& pose, double along, double across) {
    return pose.pointToWorld({along, 0.013, across});
}

TEST(HardMotionTest, UpdateRatesFromThirtyToAThousandHertzGiveTheSameVelocity) {
    const SceneSurface surface = plate();
    for (const double rate : {30.0, 45.0, 59.94, 60.0, 72.0, 90.0, 120.0, 144.0, 240.0, 500.0, 1000.0}) {
        ContactTracker tracker(sceneOf({surface}, 0.004));
        const auto readings =
            play(tracker,
                 sampledPath(1.0, rate, [&](double time) { return onPlate(surface.pose, 0.24 * time, 0.07 * time); }));
        for (std::size_t frame = 2; frame < readings.size(); ++frame) {
            ASSERT_TRUE(readings[frame].touching);
            // The first axis is along the grain (3, 0, 4) / 5, the second along (4, 0, -3) / 5.
            EXPECT_NEAR(readings[frame].tangentialVelocityMps.x, 0.6 * 0.24 + 0.8 * 0.07, 1e-9) << rate << " Hz";
            EXPECT_NEAR(readings[frame].tangentialVelocityMps.y, 0.8 * 0.24 - 0.6 * 0.07, 1e-9) << rate << " Hz";
        }
    }
}

TEST(HardMotionTest, SpeedsFromAMillimetrePerSecondToTwentyMetresPerSecondAreMeasuredCorrectly) {
    const SceneSurface surface = plate();
    for (const double rate : {30.0, 72.0, 90.0, 120.0, 1000.0}) {
        for (const double speed : {0.001, 0.02, 1.5, 20.0}) {
            ContactTracker tracker(sceneOf({surface}, 0.004));
            const auto readings = play(
                tracker, sampledPath(0.5, rate, [&](double time) { return onPlate(surface.pose, speed * time, 0.0); }));
            for (std::size_t frame = 2; frame < readings.size(); ++frame) {
                EXPECT_NEAR(speedOf(readings[frame]), speed, 1e-9) << speed << " m/s at " << rate << " Hz";
            }
            EXPECT_EQ(tracker.statistics().teleports, 0U) << speed << " m/s at " << rate << " Hz";
        }
    }
}

TEST(HardMotionTest, TheVelocityIsLimitedToTheMaximumSpeed) {
    const SceneSurface surface = plate();
    for (const double rate : {30.0, 72.0, 90.0, 1000.0}) {
        for (const double speed : {20.00001, 20.01, 25.0, 300.0, 1e6}) {
            ContactTracker tracker(sceneOf({surface}, 0.004));
            const auto readings = play(tracker, sampledPath(0.5, rate, [&](double time) {
                                           return onPlate(surface.pose, -10.0 + speed * time, 0.0);
                                       }));
            for (const ContactReading& reading : readings) {
                EXPECT_TRUE(isSane(reading)) << speed << " m/s at " << rate << " Hz";
            }
        }
    }
}

TEST(HardMotionTest, TheVelocityNeverExceedsTheStrokesSpeedForAnyMixOfTimeSteps) {
    std::mt19937 random(37);
    const SceneSurface surface = plate();
    ContactTracker tracker(sceneOf({surface}, 0.004));
    double time = 0.0;
    bool moved = false;
    for (int frame = 0; frame < 20000; ++frame) {
        const double steps[]{1.0 / 90.0, 1.0 / 90.0, 1.0 / 30.0, 0.001, 1e-6, 0.0, -0.0, -1e-6, -0.02, 10.0};
        time += steps[random() % std::size(steps)];
        time = time > 60.0 ? 0.0 : time;
        const ContactReading reading =
            tracker.update({time, onPlate(surface.pose, 0.2 * time - 5.0, 0.0), std::nullopt, std::nullopt});
        ASSERT_TRUE(reading.touching);
        ASSERT_TRUE(isSane(reading));
        ASSERT_LT(speedOf(reading), 0.2 + 1e-6) << "frame " << frame;
        moved = moved || speedOf(reading) > 0.2 - 1e-6;
    }
    EXPECT_TRUE(moved);
    EXPECT_EQ(tracker.statistics().teleports, 0U);
    EXPECT_EQ(tracker.statistics().touchDowns, 1U);
}

TEST(HardMotionTest, AStrokeADayLaterGivesTheSameReadings) {
    constexpr double daySeconds = 86'400.0;
    const SceneSurface surface = plate();
    // At 64 Hz every time of a day is exact in a double, so that only the tracker could cause an error; at 72 Hz the
    // sample's time itself is rounded to 2^-36 s.
    for (const auto& [rate, toleranceMps] : {std::pair(64.0, 0.0), {72.0, 1e-9}, {90.0, 1e-9}}) {
        ContactTracker now(sceneOf({surface}, 0.004));
        ContactTracker later(sceneOf({surface}, 0.004));
        const auto samples = sampledPath(2.0, rate, [&](double time) {
            const double depth = time < 0.1 ? 0.05 : 0.0;
            return onPlate(surface.pose, 0.2 * std::sin(3.0 * time), 0.1 * time) +
                   surface.pose.directionToWorld({0.0, depth, 0.0});
        });
        for (TipSample sample : samples) {
            const ContactReading wanted = now.update(sample);
            sample.timeSeconds += daySeconds;
            const ContactReading reading = later.update(sample);
            ASSERT_EQ(reading.touching, wanted.touching);
            ASSERT_EQ(reading.touchCounter, wanted.touchCounter);
            ASSERT_EQ(reading.forceNewtons, wanted.forceNewtons);
            ASSERT_NEAR(reading.tangentialVelocityMps.x, wanted.tangentialVelocityMps.x, toleranceMps) << rate << " Hz";
            ASSERT_NEAR(reading.tangentialVelocityMps.y, wanted.tangentialVelocityMps.y, toleranceMps) << rate << " Hz";
            ASSERT_NEAR(reading.approachSpeedMps, wanted.approachSpeedMps, 10.0 * toleranceMps) << rate << " Hz";
        }
        EXPECT_EQ(later.statistics().touchDowns, 1U);
        EXPECT_EQ(later.statistics().teleports, 0U);
    }
}

TEST(HardMotionTest, ASurfaceThatMovesAndTurnsWithTheTipHasZeroVelocity) {
    const Pose home = plate().pose;
    const glm::dvec3 normal(0.0, 1.0, 0.0);
    for (const double rate : {30.0, 90.0, 1000.0}) {
        SceneSurface surface = plate();
        surface.motion.emplace(std::vector<Keyframe>{{0.0, home},
                                                     {0.4, {{0.5, -0.1, 0.1}, home.rotation * turned(80.0, normal)}},
                                                     {1.0, {{0.2, 0.4, -0.3}, home.rotation * turned(10.0, normal)}}},
                               false);
        ContactTracker tracker(sceneOf({surface}, 0.004));
        const auto readings = play(
            tracker, sampledPath(1.0, rate, [&](double time) { return onPlate(surface.poseAt(time), 0.3, -0.2); }));
        for (const ContactReading& reading : readings) {
            ASSERT_TRUE(reading.touching);
            EXPECT_LT(speedOf(reading), 1e-9) << rate << " Hz at " << reading.timeSeconds;
            EXPECT_NEAR(reading.penetrationMetres, 0.001, 1e-9);
        }
        EXPECT_EQ(readings.back().touchCounter, 1U);
    }
}

TEST(HardMotionTest, ASurfaceThatTumblesWithTheTipHasAtMostItsTurnAcrossTheTipsRadius) {
    const Pose home = plate().pose;
    const glm::dquat tumbled = turned(90.0, {0.0, 0.0, 1.0}) * home.rotation;
    for (const double rate : {30.0, 90.0, 1000.0}) {
        SceneSurface surface = plate();
        surface.motion.emplace(std::vector<Keyframe>{{0.0, home}, {0.5, {{0.5, -0.1, 0.1}, tumbled}}}, false);
        ContactTracker tracker(sceneOf({surface}, 0.004));
        const auto readings = play(
            tracker, sampledPath(0.5, rate, [&](double time) { return onPlate(surface.poseAt(time), 0.3, -0.2); }));
        for (const ContactReading& reading : readings) {
            ASSERT_TRUE(reading.touching);
            // The pen itself does not turn, so that its tip rolls on the surface, which turns by pi radians per second.
            EXPECT_LT(speedOf(reading), std::numbers::pi * 0.004) << rate << " Hz at " << reading.timeSeconds;
        }
    }
}

TEST(HardMotionTest, ASurfaceThatMovesUnderARestingTipGivesTheOppositeOfItsVelocity) {
    for (const double rate : {30.0, 90.0, 1000.0}) {
        for (const double speed : {0.001, 0.3, 1.5}) {
            SceneSurface belt = plate();
            const glm::dvec3 travel = belt.pose.directionToWorld({speed, 0.0, 0.0});
            belt.motion.emplace(
                std::vector<Keyframe>{{0.0, belt.pose}, {1.0, {belt.pose.positionMetres + travel, belt.pose.rotation}}},
                false);
            const glm::dvec3 tip = onPlate(belt.pose, 0.1, 0.1);
            ContactTracker tracker(sceneOf({belt}, 0.004));
            const auto readings = play(tracker, sampledPath(1.0, rate, [&](double) { return tip; }));
            for (const ContactReading& reading : readings) {
                ASSERT_TRUE(reading.touching);
                EXPECT_LT(speedOf(reading), speed + 1e-9) << rate << " Hz at " << reading.timeSeconds;
                // Earlier, a stop cannot be distinguished from a tracker that repeats a position.
                if (reading.timeSeconds > 0.05 + 1.0 / rate) {
                    EXPECT_NEAR(reading.tangentialVelocityMps.x, -0.6 * speed, 1e-9) << rate << " Hz";
                    EXPECT_NEAR(reading.tangentialVelocityMps.y, -0.8 * speed, 1e-9) << rate << " Hz";
                }
            }
            EXPECT_EQ(readings.back().touchCounter, 1U);
        }
    }
}

TEST(HardMotionTest, ASurfaceThatStopsAbruptlyWithTheTipGivesAtMostItsFormerSpeedAndThenZero) {
    for (const double rate : {30.0, 90.0, 1000.0}) {
        SceneSurface surface = plate();
        const glm::dvec3 travel = surface.pose.directionToWorld({0.15, 0.0, 0.0});
        surface.motion.emplace(
            std::vector<Keyframe>{{0.0, surface.pose},
                                  {0.5, {surface.pose.positionMetres + travel, surface.pose.rotation}}},
            false);
        ContactTracker tracker(sceneOf({surface}, 0.004));
        const auto readings =
            play(tracker, sampledPath(1.0, rate, [&](double time) { return onPlate(surface.poseAt(time), 0.0, 0.0); }));
        for (const ContactReading& reading : readings) {
            const bool stopping = reading.timeSeconds > 0.5 && reading.timeSeconds < 0.55 + 1.0 / rate;
            EXPECT_LT(speedOf(reading), stopping ? 0.3 : 1e-9) << rate << " Hz at " << reading.timeSeconds;
        }
    }
}

}  // namespace
}  // namespace haptoflow::headless
