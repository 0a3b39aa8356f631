#include "learning/wave_vectors.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace haptoflow::learning {
namespace {

TEST(MaterialFrameTest, TheMostDistinctRibsAreAcrossTheFirstAxisAndTheSecondVectorPointsUpward) {
    const std::vector<WaveVector> vectors{{.x = 0.0, .y = 0.8}, {.x = 0.5, .y = 0.0}};
    const MaterialFrame frame = MaterialFrame::across(vectors);
    EXPECT_NEAR(frame.turnRadians, 0.5 * std::numbers::pi, 1e-12);
    EXPECT_EQ(frame.waveNumbers, (std::array<float, 4>{0.8F, 0.0F, 0.0F, 0.5F}));
}

TEST(MaterialFrameTest, ARotatedMotionCrossesTheSameNumberOfRibsAndKeepsItsForce) {
    const std::vector<WaveVector> vectors{{.x = 0.6, .y = -0.45}};
    const MaterialFrame frame = MaterialFrame::across(vectors);
    recordings::PreparedRecording recording;
    recording.motion = {{0.08F, 0.03F, 1.5F}};
    frame.turn(recording);
    const std::array<float, 3>& turned = recording.motion[0];
    EXPECT_NEAR(frame.waveNumbers[0] * turned[0] + frame.waveNumbers[1] * turned[1], 0.6 * 0.08 - 0.45 * 0.03, 1e-7);
    EXPECT_NEAR(recording.speedMps(0), std::hypot(0.08, 0.03), 1e-7);
    EXPECT_EQ(turned[2], 1.5F);
}

TEST(MaterialFrameTest, WithoutRibsTheMotionIsNotRotated) {
    const std::vector<WaveVector> none{{.x = 0.0, .y = 0.0}};
    const MaterialFrame frame = MaterialFrame::across(none);
    EXPECT_EQ(frame.turnRadians, 0.0);
    EXPECT_EQ(frame.waveNumbers, (std::array<float, 4>{}));
}

TEST(MaterialFrameTest, AZeroVectorBeforeARealOneIsSkipped) {
    const std::vector<WaveVector> vectors{{.x = 0.0, .y = 0.0}, {.x = 0.0, .y = 0.5}};
    EXPECT_EQ(MaterialFrame::across(vectors).waveNumbers, (std::array<float, 4>{0.5F, 0.0F, 0.0F, 0.0F}));
}

}  // namespace
}  // namespace haptoflow::learning
