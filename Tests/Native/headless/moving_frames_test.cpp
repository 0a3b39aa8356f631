#include "headless/contact_tracker.hpp"

#include "test_scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <random>
#include <string>
#include <utility>
#include <vector>

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

TEST(MovingFramesTest, SteadyMotionIsMeasuredExactlyAtEveryUpdateRateAndSpeedAndLimitedAboveTheMaximum) {
    const SceneSurface surface = plate();
    for (const double rate : {30.0, 59.94, 72.0, 90.0, 120.0, 1000.0, 10000.0}) {
        for (const double speed : {0.001, 0.25, 1.5, 20.0, 20.01, 1e6}) {
            SCOPED_TRACE(std::to_string(speed) + " m/s at " + std::to_string(rate) + " Hz");
            ContactTracker tracker(sceneOf({surface}, 0.004));
            const auto readings = play(tracker, sampledPath(0.2, rate, [&](double time) {
                                           return onPlate(surface.pose, 0.96 * speed * time, 0.28 * speed * time);
                                       }));
            const bool isMeasured = speed <= 20.0;
            for (std::size_t frame = rate > 2000.0 ? 100 : 2; frame < readings.size(); ++frame) {
                ASSERT_TRUE(isSane(readings[frame]));
                if (isMeasured) {
                    ASSERT_TRUE(readings[frame].touching);
                    // The first axis is along the grain (3, 0, 4) / 5, the second along (4, 0, -3) / 5.
                    ASSERT_NEAR(readings[frame].tangentialVelocityMps.x, 0.8 * speed, 1e-6);
                    ASSERT_NEAR(readings[frame].tangentialVelocityMps.y, 0.6 * speed, 1e-6);
                }
            }
            EXPECT_TRUE(!isMeasured || tracker.statistics().teleports == 0);
        }
    }
}

TEST(MovingFramesTest, TheVelocityNeverExceedsTheStrokesSpeedForAnyMixOfTimeSteps) {
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

TEST(MovingFramesTest, AStrokeADayLaterGivesTheSameReadings) {
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

TEST(MovingFramesTest, ASurfaceThatMovesUnderARestingTipGivesTheOppositeOfItsVelocity) {
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

/// A panel in a vehicle: a board of 40 cm at the vehicle's pose.
SceneSurface panel() {
    return surfaceOf(Box{{0.4, 0.02, 0.4}});
}

/// A circle of 5 cm on the board at 0.2 m/s, in its coordinates; the tip has a radius of 2 mm.
glm::dvec3 circle(double time) {
    return {0.05 * std::cos(4.0 * time), 0.011, 0.05 * std::sin(4.0 * time)};
}

TEST(MovingFramesTest, ASlowTrackerCarriedInALiftIsHeldAndNotStopped) {
    // 60 Hz tracking in 90 Hz frames, on a panel that rises at 3 m/s with the pen.
    SceneSurface lift = panel();
    lift.motion.emplace(std::vector<Keyframe>{{0.0, {}}, {2.0, {{0.0, 6.0, 0.0}, {1.0, 0.0, 0.0, 0.0}}}}, false);
    ContactTracker tracker(sceneOf({lift}, 0.002));
    const auto readings = play(tracker, sampledPath(2.0, 90.0, [&](double time) {
                                   const double tick = std::floor(60.0 * time + 1e-6) / 60.0;
                                   return lift.poseAt(time).pointToWorld({0.1 * tick, 0.011, 0.0});
                               }));
    for (const ContactReading& reading : readings) {
        ASSERT_TRUE(reading.touching);
        if (reading.timeSeconds > 0.1) {
            ASSERT_NEAR(speedOf(reading), 0.1, 0.005) << reading.timeSeconds;
        }
    }
}

TEST(MovingFramesTest, ASnapTurnIsNoStroke) {
    // The rig turns about the head, half a metre from the pen, which draws before and after.
    for (const double rate : {72.0, 90.0, 120.0}) {
        for (const double degrees : {15.0, 30.0, 45.0, 90.0, 180.0}) {
            ContactTracker tracker(sceneOf({surfaceOf(Box{{4.0, 0.02, 4.0}})}, 0.002));
            const auto readings = play(tracker, sampledPath(1.0, rate, [&](double time) {
                                           const glm::dquat rig = turned(time < 0.5 ? 0.0 : degrees, {0.0, 1.0, 0.0});
                                           return rig * (glm::dvec3(0.5, 0.0, 0.0) + circle(time));
                                       }));
            for (const ContactReading& reading : readings) {
                ASSERT_TRUE(reading.touching);
                ASSERT_LT(speedOf(reading), 0.21) << degrees << " degrees at " << reading.timeSeconds;
            }
            EXPECT_EQ(tracker.statistics().teleports, 1U);
            EXPECT_EQ(readings.back().touchCounter, 1U);
            EXPECT_NEAR(speedOf(readings.back()), 0.2, 0.002);
        }
    }
}

TEST(MovingFramesTest, AJumpOntoASurfaceIsNoBlow) {
    // Teleported, recentred, or found again by the tracker: from the air onto the board.
    for (const double rate : {72.0, 90.0, 120.0}) {
        ContactTracker tracker(sceneOf({panel()}, 0.002));
        const auto readings = play(tracker, sampledPath(1.0, rate, [](double time) {
                                       return time < 0.5 ? glm::dvec3(0.0, 0.3, 0.0) : circle(time);
                                   }));
        EXPECT_TRUE(readings.back().touching);
        EXPECT_EQ(readings.back().approachSpeedMps, 0.0);
        for (const ContactReading& reading : readings) {
            EXPECT_LT(speedOf(reading), 0.21);
        }
    }
}

TEST(MovingFramesTest, AStrokeOfThreeMetresASecondWithAHardStopIsNoJump) {
    for (const double rate : {72.0, 90.0, 120.0, 200.0, 500.0}) {
        ContactTracker tracker(sceneOf({surfaceOf(Box{{8.0, 0.02, 8.0}})}, 0.002));
        // From rest to 3 m/s at 100 m/s^2, which few hands reach, then a stop within a frame.
        const auto readings = play(tracker, sampledPath(0.5, rate, [](double time) {
                                       const double going = std::clamp(time - 0.1, 0.0, 0.2);
                                       const double metres =
                                           going < 0.03 ? 50.0 * going * going : 0.045 + 3.0 * (going - 0.03);
                                       return glm::dvec3(metres, 0.011, 0.0);
                                   }));
        double fastest = 0.0;
        for (const ContactReading& reading : readings) {
            fastest = std::max(fastest, speedOf(reading));
        }
        // A parabola through the start runs ahead by up to half of a frame's gain.
        EXPECT_NEAR(fastest, 3.0, 0.5) << rate;
        EXPECT_EQ(tracker.statistics().teleports, 0U) << rate;
        EXPECT_EQ(speedOf(readings.back()), 0.0);
    }
}

TEST(MovingFramesTest, APoseThatAHitchRepeatsOnceIsNoStop) {
    // 10 frames a second, of which one shows the position of the frame before: the hand went on.
    ContactTracker tracker(sceneOf({surfaceOf(Box{{4.0, 0.02, 4.0}})}, 0.002));
    double time = 0.0;
    double fastest = 0.0;
    for (int frame = 0; frame < 40; ++frame) {
        const bool isHitch = frame == 20;
        const double shown = isHitch ? time : time + 1.0 / 90.0;
        time += isHitch ? 0.2 : 1.0 / 90.0;
        const ContactReading reading =
            tracker.update({time, {0.2 * (isHitch ? shown : time), 0.011, 0.0}, std::nullopt, std::nullopt});
        fastest = std::max(fastest, speedOf(reading));
    }
    EXPECT_LT(fastest, 0.21);
}

/// A stroke is felt alike in a world that moves, turns and is shifted, whatever the tip does there.
TEST(MovingFramesTest, RandomCarriersGiveTheReadingsOfAWorldAtRest) {
    std::mt19937 random(46);
    const auto number = [&](double from, double to) {
        return from + (to - from) * static_cast<double>(random()) / 4294967296.0;
    };
    for (int round = 0; round < 60; ++round) {
        std::vector<Keyframe> keyframes;
        const double reach = std::pow(10.0, number(-1.0, 2.5));
        for (int index = 0; index <= 10; ++index) {
            keyframes.push_back(
                {0.2 * index,
                 {{number(-reach, reach), number(-reach, reach), number(-reach, reach)},
                  glm::normalize(glm::dquat(2.0, number(-1.0, 1.0), number(-1.0, 1.0), number(-1.0, 1.0)))}});
        }
        SceneSurface carried = panel();
        carried.motion.emplace(keyframes, false);
        const double rate = number(30.0, 240.0);
        const double speed = number(0.02, 1.0);
        const double lift = number(0.0, 0.004);
        const auto stroke = [&](double time) {
            const double angle = speed / 0.05 * time;
            return glm::dvec3(0.05 * std::cos(angle), 0.0115 + lift * std::sin(7.0 * time), 0.05 * std::sin(angle));
        };
        ContactTracker here(sceneOf({panel()}, 0.002));
        ContactTracker there(sceneOf({carried}, 0.002));
        const auto wanted = play(here, sampledPath(2.0, rate, stroke));
        const auto readings =
            play(there,
                 sampledPath(2.0, rate, [&](double time) { return carried.poseAt(time).pointToWorld(stroke(time)); }));
        for (std::size_t frame = 0; frame < wanted.size(); ++frame) {
            ASSERT_EQ(readings[frame].touching, wanted[frame].touching) << round << ", frame " << frame;
            ASSERT_EQ(readings[frame].touchCounter, wanted[frame].touchCounter) << round << ", frame " << frame;
            ASSERT_NEAR(readings[frame].tangentialVelocityMps.x, wanted[frame].tangentialVelocityMps.x, 1e-5);
            ASSERT_NEAR(readings[frame].tangentialVelocityMps.y, wanted[frame].tangentialVelocityMps.y, 1e-5);
            ASSERT_NEAR(readings[frame].approachSpeedMps, wanted[frame].approachSpeedMps, 1e-5);
        }
    }
}

}  // namespace
}  // namespace haptoflow::headless
