#include "engine/range_law.hpp"

#include "engine/test_model.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace haptoflow::engine {
namespace {

Material material(double speed, double force, double frequency) {
    Material result;
    result.speedLevelExponent = speed;
    result.forceLevelExponent = force;
    result.frequencyExponent = frequency;
    return result;
}

TEST(RangeLawTest, InsideTheRangeNothingChanges) {
    const model::ModelFile model = testing::smallModel();
    const RangedMotion ranged = applyRangeLaw(model.header(), material(1.0, 0.5, 1.0), {0.3F, -0.2F}, 2.0F);
    EXPECT_FLOAT_EQ(ranged.motion[0], 0.3F);
    EXPECT_FLOAT_EQ(ranged.motion[1], -0.2F);
    EXPECT_FLOAT_EQ(ranged.motion[2], 2.0F);
    EXPECT_EQ(ranged.levelGain, 1.0);
    EXPECT_EQ(ranged.readingRate, 1.0);
}

TEST(RangeLawTest, BeyondTheRangeTheMotionIsClampedInItsDirection) {
    const model::ModelFile model = testing::smallModel();
    const RangedMotion ranged = applyRangeLaw(model.header(), material(0.0, 0.0, 0.0), {1.2F, 1.6F}, 8.0F);
    EXPECT_NEAR(std::hypot(ranged.motion[0], ranged.motion[1]), 0.4, 1e-6);
    EXPECT_NEAR(ranged.motion[1] / ranged.motion[0], 4.0 / 3.0, 1e-5);
    EXPECT_FLOAT_EQ(ranged.motion[2], 4.0F);
}

TEST(RangeLawTest, LevelAndReadingRateFollowTheLabelsExponents) {
    const model::ModelFile model = testing::smallModel();
    const RangedMotion ranged = applyRangeLaw(model.header(), material(1.0, 0.5, 0.5), {0.8F, 0.0F}, 16.0F);
    EXPECT_NEAR(ranged.levelGain, 2.0 * 2.0, 1e-6);
    EXPECT_NEAR(ranged.readingRate, std::sqrt(2.0), 1e-6);
}

TEST(RangeLawTest, LevelAndReadingRateAreLimited) {
    const model::ModelFile model = testing::smallModel();
    const RangedMotion ranged = applyRangeLaw(model.header(), material(2.0, 1.0, 1.0), {20.0F, 0.0F}, 1000.0F);
    EXPECT_EQ(ranged.levelGain, 16.0);
    EXPECT_EQ(ranged.readingRate, 4.0);
}

TEST(RangeLawTest, ASlowSweepAcrossTheEdgeOfTheRangeHasNoStep) {
    const model::ModelFile model = testing::smallModel();
    const Material mesh = material(0.97, 0.21, 1.0);
    RangedMotion last = applyRangeLaw(model.header(), mesh, {0.0F, 0.0F}, 0.0F);
    for (int i = 1; i <= 20000; ++i) {
        const float share = static_cast<float>(i) / 20000.0F;
        const RangedMotion ranged = applyRangeLaw(model.header(), mesh, {2.0F * share, 0.0F}, 10.0F * share);
        ASSERT_LE(std::abs(ranged.levelGain - last.levelGain), 1e-3);
        ASSERT_LE(std::abs(ranged.readingRate - last.readingRate), 1e-3);
        ASSERT_LE(std::abs(ranged.motion[0] - last.motion[0]), 1e-3F);
        ASSERT_LE(std::abs(ranged.motion[2] - last.motion[2]), 1e-3F);
        last = ranged;
    }
}

}  // namespace
}  // namespace haptoflow::engine
