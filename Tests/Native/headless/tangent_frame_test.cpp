#include "headless/pose.hpp"

#include "headless/scene.hpp"
#include "test_scenes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace haptoflow::headless {
namespace {

using testing::degreesBetween;
using testing::infinity;
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

TEST(MotionTest, UnusableRotationsBecomeTheIdentity) {
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

constexpr double frameSeconds = 1.0 / 90.0;

void expectOrthonormal(const TangentAxes& axes, const glm::dvec3& normal) {
    EXPECT_NEAR(glm::length(axes.first), 1.0, 1e-9);
    EXPECT_NEAR(glm::dot(axes.first, normal), 0.0, 1e-9);
    EXPECT_LT(glm::distance(glm::cross(axes.first, axes.second), normal), 1e-9);
}

TEST(TangentFrameTest, TheFirstAxisIsTheGrainAndTheAxesHaveTheHandednessOfXYZ) {
    TangentFrame frame({1.0, 0.5, 0.0});
    const TangentAxes axes = frame.update({0.0, 1.0, 0.0}, frameSeconds);
    EXPECT_LT(glm::distance(axes.first, {1.0, 0.0, 0.0}), 1e-12);
    EXPECT_LT(glm::distance(axes.second, {0.0, 0.0, -1.0}), 1e-12);
    expectOrthonormal(axes, {0.0, 1.0, 0.0});
}

TEST(TangentFrameTest, AxesStayContinuousAlongAGreatCircleOverThePole) {
    for (const double degreesPerFrame : {0.25, 1.0, 2.0}) {
        TangentFrame frame({0.0, 1.0, 0.0});
        TangentAxes last;
        bool first = true;
        double worst = 0.0;
        // At 0.001 degrees from the pole the projection of the grain turns by half a turn within one frame.
        const glm::dquat tilt = testing::turned(0.001, {1.0, 0.0, 0.0});
        for (double angle = -90.0; angle <= 450.0; angle += degreesPerFrame) {
            const glm::dvec3 normal = tilt * (testing::turned(angle, {0.0, 0.0, 1.0}) * glm::dvec3(0.0, 1.0, 0.0));
            const TangentAxes axes = frame.update(normal, frameSeconds);
            expectOrthonormal(axes, normal);
            if (!first) {
                worst = std::max(worst, degreesBetween(axes.first, last.first));
            }
            last = axes;
            first = false;
        }
        EXPECT_LT(worst, degreesPerFrame + 0.5) << degreesPerFrame << " degrees a frame";
    }
}

TEST(TangentFrameTest, AxesTurnByAFewDegreesAtMostAlongRandomStrokesOverASphere) {
    std::mt19937 random(1);
    std::normal_distribution<double> gaussian;
    double worst = 0.0;
    for (int stroke = 0; stroke < 200; ++stroke) {
        TangentFrame frame({1.0, 0.0, 0.0});
        glm::dvec3 normal = glm::normalize(glm::dvec3(gaussian(random), gaussian(random), gaussian(random)));
        glm::dvec3 axis = glm::normalize(glm::dvec3(gaussian(random), gaussian(random), gaussian(random)));
        TangentAxes last = frame.update(normal, frameSeconds);
        for (int step = 0; step < 400; ++step) {
            axis = glm::normalize(axis + 0.1 * glm::dvec3(gaussian(random), gaussian(random), gaussian(random)));
            normal = glm::normalize(testing::turned(1.0, axis) * normal);
            const TangentAxes axes = frame.update(normal, frameSeconds);
            expectOrthonormal(axes, normal);
            worst = std::max(worst, degreesBetween(axes.first, last.first));
            last = axes;
        }
    }
    EXPECT_LT(worst, 7.0);
}

TEST(TangentFrameTest, TheFirstAxisIsParallelToTheGrainAwayFromThePolesForEveryStroke) {
    std::mt19937 random(2);
    std::normal_distribution<double> gaussian;
    const glm::dvec3 grain(0.0, 0.0, 1.0);
    for (int stroke = 0; stroke < 100; ++stroke) {
        TangentFrame frame(grain);
        // A circle of latitude 40 degrees from the grain's pole at 3 degrees per frame: the grain's projection turns
        // against parallel transport on the whole circle.
        const double start = 360.0 * gaussian(random);
        for (double angle = 0.0; angle < 720.0; angle += 3.0) {
            const glm::dvec3 normal =
                testing::turned(start + angle, grain) * (testing::turned(40.0, {1.0, 0.0, 0.0}) * grain);
            const glm::dvec3 projected = glm::normalize(grain - normal * glm::dot(grain, normal));
            EXPECT_LT(degreesBetween(frame.update(normal, frameSeconds).first, projected), 1e-6);
        }
    }
}

TEST(TangentFrameTest, TheAxesReturnToTheGrainAfterThePoleAndANewTouchToItsSign) {
    TangentFrame frame({0.0, 1.0, 0.0});
    glm::dvec3 normal;
    TangentAxes axes;
    for (double angle = -60.0; angle <= 60.0; angle += 1.0) {
        normal = testing::turned(angle, {0.0, 0.2, 1.0}) * glm::normalize(glm::dvec3(0.02, 1.0, 0.0));
        axes = frame.update(normal, frameSeconds);
    }
    const glm::dvec3 projected = glm::normalize(glm::dvec3(0.0, 1.0, 0.0) - normal * normal.y);
    EXPECT_LT(degreesBetween(axes.first, -projected), 0.1);
    frame.reset();
    EXPECT_LT(degreesBetween(frame.update(normal, frameSeconds).first, projected), 1e-9);
}

TEST(TangentFrameTest, FlippedZeroLongAndUnusableNormalsGiveOrthonormalAxes) {
    for (const glm::dvec3& grain :
         {glm::dvec3(1.0, 0.0, 0.0), glm::dvec3(0.0), glm::dvec3(nan, 0.0, 0.0), glm::dvec3(0.0, 1e-200, 0.0)}) {
        TangentFrame frame(grain);
        glm::dvec3 known(0.0, 1.0, 0.0);
        for (const glm::dvec3& normal :
             {glm::dvec3(0.0), glm::dvec3(0.0, 1.0, 0.0), glm::dvec3(0.0, -1.0, 0.0), glm::dvec3(nan, nan, nan),
              glm::dvec3(0.0, 0.0, 1e-6), glm::dvec3(1e6, 0.0, 0.0), glm::dvec3(1e200, 0.0, 1e200),
              glm::dvec3(infinity, 0.0, 0.0), glm::dvec3(0.0, 0.0, -1e-200)}) {
            const bool usable = std::isfinite(normal.x) && (normal.x != 0.0 || normal.y != 0.0 || normal.z != 0.0);
            if (usable) {
                known = normal / std::max({std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)});
                known = glm::normalize(known);
            }
            for (const double step : {frameSeconds, 0.0, -1.0, nan}) {
                expectOrthonormal(frame.update(normal, step), known);
            }
        }
    }
}

}  // namespace
}  // namespace haptoflow::headless
