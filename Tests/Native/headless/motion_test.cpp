#include "headless/motion.hpp"

#include "test_scenes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

namespace haptoflow::headless {
namespace {

using testing::nan;
using testing::turned;

const glm::dquat upright(1.0, 0.0, 0.0, 0.0);

TEST(MotionTest, TwoKeyframesGiveAStraightLineAtConstantSpeedWithRestAtItsEnds) {
    const Motion motion({{1.0, {{0.0, 0.0, 0.0}, upright}}, {3.0, {{0.4, 0.0, 0.0}, upright}}}, false);
    EXPECT_NEAR(motion.poseAt(1.5).positionMetres.x, 0.1, 1e-12);
    EXPECT_NEAR(motion.poseAt(2.5).positionMetres.x, 0.3, 1e-12);
    EXPECT_DOUBLE_EQ(motion.poseAt(0.0).positionMetres.x, 0.0);
    EXPECT_DOUBLE_EQ(motion.poseAt(9.0).positionMetres.x, 0.4);
}

TEST(MotionTest, VelocityIsContinuousAtInnerKeyframesAndAcrossAClosedLoop) {
    const Motion motion({{0.0, {{0.0, 0.0, 0.0}, upright}},
                         {0.3, {{0.1, 0.0, 0.2}, upright}},
                         {1.0, {{0.3, 0.1, 0.0}, upright}},
                         {1.4, {{0.0, 0.0, 0.0}, upright}}},
                        true);
    const double h = 1e-6;
    for (const double time : {0.3, 1.0, 1.4, 2.8}) {
        const glm::dvec3 before = (motion.poseAt(time).positionMetres - motion.poseAt(time - h).positionMetres) / h;
        const glm::dvec3 after = (motion.poseAt(time + h).positionMetres - motion.poseAt(time).positionMetres) / h;
        EXPECT_LT(glm::distance(before, after), 1e-4) << "at " << time;
    }
}

TEST(MotionTest, RotationTakesTheShorterWayAtConstantRate) {
    const Motion motion({{0.0, {{}, upright}}, {1.0, {{}, -turned(90.0, {0.0, 1.0, 0.0})}}}, false);
    const glm::dvec3 x = motion.poseAt(0.5).directionToWorld({1.0, 0.0, 0.0});
    EXPECT_NEAR(testing::degreesBetween(x, {1.0, 0.0, 0.0}), 45.0, 1e-9);
}

TEST(MotionTest, ALoopRepeatsWithoutEndInBothDirections) {
    const Motion motion(
        {{1.0, {{0.0, 0.0, 0.0}, upright}}, {1.5, {{0.1, 0.0, 0.0}, upright}}, {2.0, {{0.0, 0.0, 0.0}, upright}}},
        true);
    EXPECT_NEAR(motion.poseAt(1001.25).positionMetres.x, motion.poseAt(1.25).positionMetres.x, 1e-9);
    EXPECT_NEAR(motion.poseAt(-0.75).positionMetres.x, motion.poseAt(1.25).positionMetres.x, 1e-9);
}

TEST(MotionTest, UnusableTimesAreRefusedAndUnusableRotationsBecomeTheIdentity) {
    EXPECT_THROW(Motion({{0.0, {}}}, false), std::invalid_argument);
    EXPECT_THROW(Motion({{0.0, {}}, {0.0, {}}}, false), std::invalid_argument);
    EXPECT_THROW(Motion({{0.0, {}}, {nan, {}}}, false), std::invalid_argument);
    const Motion motion({{0.0, {{}, {0.0, 0.0, 0.0, 0.0}}}, {1.0, {{}, {nan, 0.0, 0.0, 0.0}}}}, false);
    EXPECT_EQ(motion.poseAt(0.5).rotation, upright);
    EXPECT_EQ(motion.poseAt(nan).rotation, upright);
}

TEST(MotionTest, EveryPointOfThePathIsWithinTheBounds) {
    std::mt19937 random(59);
    std::uniform_real_distribution<double> spread(-1.0, 1.0);
    for (int trial = 0; trial < 100; ++trial) {
        std::vector<Keyframe> keyframes;
        double time = spread(random);
        for (int index = 0; index < 2 + trial % 5; ++index) {
            keyframes.push_back({time, {{spread(random), spread(random), spread(random)}, {1.0, 0.0, 0.0, 0.0}}});
            time += std::pow(10.0, 2.0 * spread(random));
        }
        if (trial % 3 == 0) {
            keyframes.back().pose = keyframes.front().pose;
        }
        const Motion motion(keyframes, trial % 2 == 0);
        const Bounds bounds = motion.bounds();
        for (int step = -100; step <= 1100; ++step) {
            const double now =
                keyframes[0].timeSeconds + (keyframes.back().timeSeconds - keyframes[0].timeSeconds) * (step / 1000.0);
            EXPECT_LE(bounds.squaredDistanceTo(motion.poseAt(now).positionMetres), 1e-24);
        }
    }
}

TEST(MotionTest, BoundsOfAStraightPathAreItsEnds) {
    const Motion motion(
        {{0.0, {{1.0, 2.0, 3.0}, {1.0, 0.0, 0.0, 0.0}}}, {4.0, {{-1.0, 2.5, 7.0}, {1.0, 0.0, 0.0, 0.0}}}}, false);
    EXPECT_LT(glm::distance(motion.bounds().lowest, glm::dvec3(-1.0, 2.0, 3.0)), 1e-12);
    EXPECT_LT(glm::distance(motion.bounds().highest, glm::dvec3(1.0, 2.5, 7.0)), 1e-12);
}

}  // namespace
}  // namespace haptoflow::headless
