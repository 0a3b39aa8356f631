#include "headless/relative_velocity.hpp"

#include "test_scenes.hpp"

#include <gtest/gtest.h>

#include <random>

namespace haptoflow::headless {
namespace {

using testing::sampledPath;
using testing::surfaceOf;

const SceneSurface table = surfaceOf(Plane{});

/// The speed after each sample.
std::vector<double> speedsOf(const std::vector<TipSample>& samples, const SceneSurface& surface = table) {
    TipHistory history{VelocitySettings{}};
    std::vector<double> speeds;
    for (const TipSample& sample : samples) {
        history.add(sample.timeSeconds, sample.positionMetres);
        speeds.push_back(glm::length(relativeVelocity(history, surface, glm::dvec3(0.0))));
    }
    return speeds;
}

glm::dvec3 alongX(double metres) {
    return {metres, 0.0, 0.0};
}

TEST(VelocityTest, SteadyMotionIsExactFromTheThirdFrameOn) {
    for (const double rate : {72.0, 90.0, 120.0, 1000.0}) {
        const auto speeds = speedsOf(sampledPath(0.5, rate, [](double time) { return alongX(0.3 * time); }));
        for (std::size_t frame = 2; frame < speeds.size(); ++frame) {
            EXPECT_NEAR(speeds[frame], 0.3, 1e-9) << rate << " Hz, frame " << frame;
        }
    }
}

TEST(VelocityTest, AThirdOfTheSamplesRepeatedAtRandomChangesNothing) {
    std::mt19937 random(4);
    for (const double rate : {72.0, 90.0, 120.0}) {
        auto samples = sampledPath(4.0, rate, [](double time) { return alongX(0.3 * time); });
        int run = 0;
        for (std::size_t frame = 1; frame < samples.size(); ++frame) {
            run = random() % 3 == 0 && run < 2 ? run + 1 : 0;
            if (run > 0) {
                samples[frame].positionMetres = samples[frame - 1].positionMetres;
            }
        }
        const auto speeds = speedsOf(samples);
        for (std::size_t frame = 6; frame < speeds.size(); ++frame) {
            EXPECT_NEAR(speeds[frame], 0.3, 0.015) << rate << " Hz, frame " << frame;
        }
    }
}

TEST(VelocityTest, TheVelocityOfATrackerAtTwoThirdsOfTheFrameRateIsWithinFivePercent) {
    // The pattern of real trackers: each position is as old as the tracker's last measurement.
    for (const double rate : {72.0, 90.0, 108.0, 120.0}) {
        const double tick = 1.5 / rate;
        const auto samples = sampledPath(
            4.0, rate, [&](double time) { return alongX(0.3 * tick * std::floor((time + 0.2 * tick) / tick)); });
        const auto speeds = speedsOf(samples);
        for (std::size_t frame = 6; frame < speeds.size(); ++frame) {
            EXPECT_NEAR(speeds[frame], 0.3, 0.015) << rate << " Hz, frame " << frame;
        }
    }
}

TEST(VelocityTest, LagIsHalfTheWindowAndStaysBelowTwentyMilliseconds) {
    const double acceleration = 2.0;
    for (const double rate : {72.0, 90.0, 120.0}) {
        const auto samples =
            sampledPath(0.5, rate, [&](double time) { return alongX(0.5 * acceleration * time * time); });
        const double speed = speedsOf(samples).back();
        const double lagSeconds = samples.back().timeSeconds - speed / acceleration;
        EXPECT_GT(lagSeconds, 0.010) << rate;
        EXPECT_LT(lagSeconds, 0.020) << rate;
    }
}

TEST(VelocityTest, ARealStopGivesZeroWithinSixtyMilliseconds) {
    for (const double rate : {72.0, 90.0, 120.0}) {
        const auto samples = sampledPath(1.0, rate, [](double time) { return alongX(0.5 * std::min(time, 0.5)); });
        const auto speeds = speedsOf(samples);
        for (std::size_t frame = 0; frame < samples.size(); ++frame) {
            if (samples[frame].timeSeconds > 0.56 + 1.0 / rate) {
                EXPECT_NEAR(speeds[frame], 0.0, 1e-6) << rate << " Hz at " << samples[frame].timeSeconds;
            }
        }
    }
}

TEST(VelocityTest, AStopFadesMonotonically) {
    const auto samples = sampledPath(1.0, 1000.0, [](double time) { return alongX(0.5 * std::min(time, 0.5)); });
    const auto speeds = speedsOf(samples);
    for (std::size_t frame = 502; frame < speeds.size(); ++frame) {
        EXPECT_LE(speeds[frame], speeds[frame - 1] + 1e-9);
        EXPECT_GT(speeds[frame], speeds[frame - 1] - 0.05);
    }
}

TEST(VelocityTest, ATipThatMovesWithATurningSurfaceHasZeroVelocity) {
    SceneSurface plate = surfaceOf(Plane{});
    plate.motion.emplace(std::vector<Keyframe>{{0.0, {{0.0, 0.0, 0.0}, testing::turned(0.0, {0.0, 1.0, 0.0})}},
                                               {1.0, {{0.5, 0.1, 0.0}, testing::turned(120.0, {0.0, 1.0, 0.0})}},
                                               {2.0, {{0.0, 0.2, 0.3}, testing::turned(240.0, {0.0, 1.0, 0.2})}}},
                         false);
    const glm::dvec3 local(0.2, 0.0, 0.1);
    TipHistory history{VelocitySettings{}};
    for (int frame = 0; frame < 180; ++frame) {
        const double time = frame / 90.0;
        history.add(time, plate.poseAt(time).pointToWorld(local));
        EXPECT_LT(glm::length(relativeVelocity(history, plate, local)), 1e-9);
    }
}

TEST(VelocityTest, ATipAtRestOnATurntableHasAngularVelocityTimesArm) {
    SceneSurface turntable = surfaceOf(Plane{});
    turntable.motion.emplace(std::vector<Keyframe>{{0.0, {{}, testing::turned(0.0, {0.0, 1.0, 0.0})}},
                                                   {1.0, {{}, testing::turned(120.0, {0.0, 1.0, 0.0})}}},
                             false);
    const glm::dvec3 tip(0.1, 0.0, 0.0);
    TipHistory history{VelocitySettings{}};
    for (int frame = 0; frame <= 60; ++frame) {
        history.add(frame / 90.0, tip);
    }
    const double now = 60.0 / 90.0;
    const glm::dvec3 velocity = relativeVelocity(history, turntable, turntable.poseAt(now).pointToLocal(tip));
    const double expected = 0.1 * 120.0 * std::numbers::pi / 180.0;
    EXPECT_NEAR(glm::length(velocity), expected, 0.005 * expected);
    // Unity turns +z towards +x about +y: the material at +x moves towards -z, the tip towards +z relative to it.
    EXPECT_NEAR(velocity.z, expected, 0.005 * expected);
}

TEST(VelocityTest, APositionHeldOnAMovingSurfaceFadesToTheSurfacesOwnSpeed) {
    SceneSurface belt = surfaceOf(Plane{});
    belt.motion.emplace(std::vector<Keyframe>{{0.0, {}}, {10.0, {{2.0, 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0}}}}, false);
    TipHistory history{VelocitySettings{}};
    double last = 0.0;
    for (int frame = 0; frame <= 90; ++frame) {
        const double time = frame / 90.0;
        history.add(time, alongX(std::min(time, 0.5) * 0.2));
        last = relativeVelocity(history, belt, glm::dvec3(0.0)).x;
        if (frame == 40) {
            EXPECT_NEAR(last, 0.0, 1e-9);
        }
    }
    EXPECT_NEAR(last, -0.2, 1e-9);
}

TEST(VelocityTest, ASurfaceThatJumpsBackAtTheEndOfItsLoopIsNotAStroke) {
    SceneSurface plate = surfaceOf(Plane{});
    plate.motion.emplace(std::vector<Keyframe>{{0.0, {}}, {1.0, {{0.5, 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0}}}}, true);
    TipHistory history{VelocitySettings{}};
    for (int frame = 0; frame <= 270; ++frame) {
        history.add(frame / 90.0, alongX(0.0));
        EXPECT_LT(glm::length(relativeVelocity(history, plate, glm::dvec3(0.0))), 0.51) << frame;
    }
}

}  // namespace
}  // namespace haptoflow::headless
