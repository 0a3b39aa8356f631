#include "dsp/level_smoother.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "test_signals.hpp"

namespace haptoflow::dsp {
namespace {

using testing::Uniform;
using testing::whiteNoise;

TEST(LevelSmootherTest, TheGainReachesItsTargetExactlyAndLinearlyWithinTheRamp) {
    LevelSmoother smoother(48000.0, 0.01, 1.0F);
    smoother.setTarget(0.3F);
    for (int i = 1; i < 480; ++i) {
        ASSERT_NEAR(smoother.next(), 1.0 - 0.7 * i / 480.0, 1e-6);
        ASSERT_FALSE(smoother.isSettled());
    }
    EXPECT_EQ(smoother.next(), 0.3F);
    EXPECT_TRUE(smoother.isSettled());
    EXPECT_EQ(smoother.next(), 0.3F);
}

TEST(LevelSmootherTest, NewTargetsAtAnySampleNeverMakeAStepLargerThanTheRangeOverTheRamp) {
    LevelSmoother smoother(48000.0, 0.01, 1.0F);
    Uniform uniform(51);
    double previous = 1.0;
    for (int i = 0; i < 100000; ++i) {
        if (uniform(0.0, 1.0) < 0.1) {
            smoother.setTarget(static_cast<float>(uniform(0.0, 2.0)));
        }
        const double gain = smoother.next();
        ASSERT_LE(std::abs(gain - previous), 2.0 / 480.0 + 1e-6);
        ASSERT_GE(gain, 0.0);
        ASSERT_LE(gain, 2.0);
        previous = gain;
    }
}

TEST(LevelSmootherTest, ANonFiniteTargetIsIgnored) {
    LevelSmoother smoother(48000.0);
    smoother.setTarget(std::numeric_limits<float>::quiet_NaN());
    smoother.setTarget(std::numeric_limits<float>::infinity());
    smoother.reset(std::numeric_limits<float>::quiet_NaN());
    EXPECT_EQ(smoother.target(), 1.0F);
    EXPECT_EQ(smoother.next(), 1.0F);
}

TEST(LevelSmootherTest, ProcessMultipliesSampleBySampleAndAUnityGainChangesNothing) {
    std::vector<float> samples = whiteNoise(300, 10.0, 52);
    const std::vector<float> original = samples;
    LevelSmoother smoother(2000.0);
    smoother.process(samples);
    EXPECT_EQ(samples, original);

    LevelSmoother twin(2000.0);
    smoother.setTarget(0.5F);
    twin.setTarget(0.5F);
    smoother.process(samples);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        ASSERT_EQ(samples[i], original[i] * twin.next());
    }
    EXPECT_EQ(samples.back(), original.back() * 0.5F);
}

TEST(LevelSmootherTest, ResetSetsTheGainAtOnce) {
    LevelSmoother smoother(48000.0);
    smoother.setTarget(0.0F);
    smoother.reset(0.25F);
    EXPECT_EQ(smoother.next(), 0.25F);
    EXPECT_TRUE(smoother.isSettled());
}

TEST(LevelSmootherTest, InvalidSettingsAreRejected) {
    EXPECT_THROW(LevelSmoother(0.0), std::invalid_argument);
    EXPECT_THROW(LevelSmoother(48000.0, -0.1), std::invalid_argument);
    EXPECT_THROW(LevelSmoother(48000.0, 0.01, std::numeric_limits<float>::quiet_NaN()), std::invalid_argument);
}

}  // namespace
}  // namespace haptoflow::dsp
