#include "headless/contact_tracker.hpp"

#include "test_scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace haptoflow::headless {
namespace {

using testing::play;
using testing::sampledPath;
using testing::sceneOf;
using testing::speedOf;
using testing::surfaceOf;
using testing::turned;

/// A panel in a vehicle: a board of 40 cm at the vehicle's pose.
SceneSurface panel() {
    return surfaceOf(Box{{0.4, 0.02, 0.4}});
}

/// The panel, driven for two seconds through a bend.
SceneSurface driven(double speedMps) {
    SceneSurface surface = panel();
    std::vector<Keyframe> keyframes;
    for (int index = 0; index <= 40; ++index) {
        const double time = 0.05 * index;
        const double angle = 0.5 * time;
        const double radius = speedMps / 0.5;
        keyframes.push_back({time,
                             {{radius * std::sin(angle), 0.0, radius * (1.0 - std::cos(angle))},
                              turned(-angle * 180.0 / std::numbers::pi, {0.0, 1.0, 0.0})}});
    }
    surface.motion.emplace(std::move(keyframes), false);
    return surface;
}

/// A circle of 5 cm on the board at 0.2 m/s, in its coordinates; the tip has a radius of 2 mm.
glm::dvec3 circle(double time) {
    return {0.05 * std::cos(4.0 * time), 0.011, 0.05 * std::sin(4.0 * time)};
}

TEST(MovingFramesTest, AStrokeInAVehicleIsTheSameAtEverySpeed) {
    for (const double rate : {72.0, 90.0, 120.0}) {
        const std::vector<ContactReading> wanted = [&] {
            ContactTracker tracker(sceneOf({panel()}, 0.002));
            return play(tracker, sampledPath(2.0, rate, circle));
        }();
        for (const double speed : {0.5, 3.0, 20.0, 30.0, 250.0}) {
            const SceneSurface surface = driven(speed);
            ContactTracker tracker(sceneOf({surface}, 0.002));
            const auto readings = play(tracker, sampledPath(2.0, rate, [&](double time) {
                                           return surface.poseAt(time).pointToWorld(circle(time));
                                       }));
            for (std::size_t frame = 0; frame < readings.size(); ++frame) {
                ASSERT_TRUE(readings[frame].touching);
                // A position of 500 m is rounded to 1e-13 m.
                ASSERT_NEAR(readings[frame].tangentialVelocityMps.x, wanted[frame].tangentialVelocityMps.x, 1e-6)
                    << speed << " m/s at " << rate << " Hz, frame " << frame;
                ASSERT_NEAR(readings[frame].tangentialVelocityMps.y, wanted[frame].tangentialVelocityMps.y, 1e-6);
            }
            EXPECT_EQ(readings.back().touchCounter, 1U);
            EXPECT_EQ(tracker.statistics().teleports, 0U);
        }
    }
}

TEST(MovingFramesTest, ATouchDownInAVehicleHasTheSpeedInItsFrame) {
    const SceneSurface surface = driven(60.0);
    ContactTracker tracker(sceneOf({surface}, 0.002));
    const auto readings = play(tracker, sampledPath(0.42, 90.0, [&](double time) {
                                   return surface.poseAt(time).pointToWorld({0.0, 0.05 - 0.1 * time, 0.0});
                               }));
    EXPECT_TRUE(readings.back().touching);
    EXPECT_EQ(readings.back().touchCounter, 1U);
    EXPECT_NEAR(readings.back().approachSpeedMps, 0.1, 1e-6);
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

TEST(MovingFramesTest, AShiftOfTheWorldIsNotFelt) {
    // Five kilometres within two frames. The spline moves the world before and after it, too.
    SceneSurface ground = surfaceOf(Box{{4.0, 0.02, 4.0}});
    const glm::dvec3 shift(-5000.0, 0.0, 300.0);
    const glm::dquat unturned(1.0, 0.0, 0.0, 0.0);
    ground.motion.emplace(
        std::vector<Keyframe>{{0.0, {}}, {0.49, {}}, {0.51, {shift, unturned}}, {1.0, {shift, unturned}}}, false);
    ContactTracker tracker(sceneOf({ground}, 0.002));
    const auto readings = play(
        tracker, sampledPath(1.0, 90.0, [&](double time) { return ground.poseAt(time).pointToWorld(circle(time)); }));
    for (std::size_t frame = 3; frame < readings.size(); ++frame) {
        ASSERT_TRUE(readings[frame].touching);
        ASSERT_NEAR(speedOf(readings[frame]), 0.2, 0.003) << frame;
    }
    EXPECT_EQ(readings.back().touchCounter, 1U);
    EXPECT_EQ(tracker.statistics().teleports, 0U);
}

TEST(MovingFramesTest, UpdateRatesOfThousandsOfHertzAreMeasuredInFull) {
    for (const double rate : {2000.0, 2500.0, 4000.0, 5000.0, 6000.0, 8000.0, 10000.0}) {
        ContactTracker tracker(sceneOf({surfaceOf(Box{{4.0, 0.02, 4.0}})}, 0.002));
        const auto readings =
            play(tracker, sampledPath(0.5, rate, [](double time) { return glm::dvec3(0.2 * time, 0.011, 0.0); }));
        for (const ContactReading& reading : readings) {
            if (reading.timeSeconds > 0.01) {
                ASSERT_NEAR(speedOf(reading), 0.2, 1e-6) << rate << " Hz at " << reading.timeSeconds;
            }
        }
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
