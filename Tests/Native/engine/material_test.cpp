#include "engine/material.hpp"

#include "engine/test_model.hpp"
#include "model/model_file.hpp"
#include "simulated_device.hpp"
#include "small_library.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace haptoflow::engine {
namespace {

TEST(MaterialTest, ABlendIsTheWeightedMeanOfItsLabelsExceptForTheWaveVectors) {
    const testing::SmallLibrary small;
    const Material mixed = resolveMaterial(small.ingredients({{0, 3.0F}, {1, 1.0F}}));
    const auto oak = small.model.embedding(0);
    const auto mesh = small.model.embedding(1);
    for (std::size_t i = 0; i < 60; ++i) {
        ASSERT_NEAR(mixed.embedding[i], 0.75F * oak[i] + 0.25F * mesh[i], 1e-6F);
    }
    EXPECT_EQ(small.ingredients({{0, 3.0F}, {1, 1.0F}}).heaviest().index, 0U);
}

TEST(MaterialTest, ASingleLabelGivesItsExactEmbeddingForAnyWeight) {
    const testing::SmallLibrary small;
    for (const float weight : {1.0F, 0.3F, 0.07F}) {
        const Ingredients alone = small.ingredients({{1, weight}, {1, weight / 3.0F}});
        EXPECT_FALSE(alone.isBlend());
        const Material material = resolveMaterial(alone);
        EXPECT_TRUE(std::ranges::equal(material.embedding, small.model.embedding(1))) << weight;
    }
}

TEST(MaterialTest, UnknownLabelsAndNegativeWeightsAreSkipped) {
    const testing::SmallLibrary small;
    const Ingredients left = small.ingredients({{99, 5.0F}, {0, -1.0F}, {1, 0.5F}});
    EXPECT_EQ(left.count, 1U);
    EXPECT_EQ(left.heaviest().index, 1U);
    EXPECT_EQ(resolveMaterial(left).embedding[3], small.model.embedding(1)[3]);
}

TEST(MaterialTest, ABlendWithoutAnyWeightIsTheFirstLabel) {
    const testing::SmallLibrary small;
    for (const MaterialBlend& empty :
         {MaterialBlend{}, testing::blendOf({{0, 0.0F}, {1, 0.0F}}), testing::blendOf({{7, 1.0F}})}) {
        EXPECT_EQ(resolveMaterial(small.ingredients(empty)).embedding[5], small.model.embedding(0)[5]);
    }
}

TEST(ContactStateTest, EveryInvalidFieldOfAStateBecomesFiniteAndIsCounted) {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    constexpr float infinity = std::numeric_limits<float>::infinity();
    ContactState state;
    state.velocityMps = {nan, infinity};
    state.forceNewtons = -3.0F;
    state.approachSpeedMps = nan;
    state.material.count = 900;
    state.material.weights[0] = nan;
    EXPECT_EQ(sanitise(state), 6U);
    EXPECT_EQ(state.velocityMps[0], 0.0F);
    EXPECT_EQ(state.velocityMps[1], 0.0F);
    EXPECT_EQ(state.forceNewtons, 0.0F);
    EXPECT_EQ(state.material.count, MaterialBlend::capacity);
    EXPECT_EQ(sanitise(state), 0U);

    struct Limited {
        float ContactState::*field;
        float given;
        float expected;
        std::uint32_t corrections = 1;
    };
    for (const auto& [field, given, expected, corrections] : {Limited{&ContactState::variation, -0.5F, 0.0F},
                                                              {&ContactState::variation, 1.5F, 1.0F},
                                                              {&ContactState::variation, infinity, 0.0F},
                                                              {&ContactState::variation, nan, 0.0F},
                                                              {&ContactState::variation, 0.25F, 0.25F, 0},
                                                              {&ContactState::spatialScale, 0.0F, 1.0F, 0},
                                                              {&ContactState::spatialScale, 0.1F, 0.25F},
                                                              {&ContactState::spatialScale, -2.0F, 0.25F},
                                                              {&ContactState::spatialScale, 100.0F, 4.0F},
                                                              {&ContactState::spatialScale, infinity, 1.0F},
                                                              {&ContactState::spatialScale, nan, 1.0F},
                                                              {&ContactState::toneDbPerOctave, -100.0F, -12.0F},
                                                              {&ContactState::toneDbPerOctave, nan, 0.0F}}) {
        state.*field = given;
        EXPECT_EQ(sanitise(state), corrections) << given;
        EXPECT_EQ(state.*field, expected) << given;
    }
}

TEST(ContactStateTest, APlaceOfNoUseIsUnknownAndCounted) {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    const auto changesOf = [](auto change) {
        ContactState state = testing::slidingAt(1.0);
        change(state);
        const std::uint32_t changes = sanitise(state);
        EXPECT_EQ(state.hasPlace, changes == 0 ? 1U : 0U);
        EXPECT_EQ(state.placeMetres[0], changes == 0 ? 1.0F : 0.0F);
        return changes;
    };
    EXPECT_EQ(changesOf([](ContactState&) {}), 0U);
    EXPECT_EQ(changesOf([](ContactState& state) { state.placeMetres[1] = nan; }), 1U);
    EXPECT_EQ(changesOf([](ContactState& state) { state.placeMetres[2] = 2e4F; }), 1U);
    EXPECT_EQ(changesOf([](ContactState& state) { state.firstAxis = {}; }), 1U);
    EXPECT_EQ(changesOf([](ContactState& state) { state.secondAxis = {0.0F, nan, 0.0F}; }), 1U);
    EXPECT_EQ(changesOf([](ContactState& state) { state.secondAxis = {5.0F, 0.0F, 0.0F}; }), 1U);
}

TEST(SeedRetrievalTest, TheSeedRecordedNearestToTheMotionIsChosenAndNoneWithoutSeeds) {
    const testing::SmallLibrary small;
    const auto& seeds = small.ingredients({{0, 1.0F}}).heaviest().material->seeds;
    // "oak" has seeds recorded at (0.1, -0.05) m/s and 1 N, and at (0.2, -0.05) m/s and 2 N.
    EXPECT_EQ(retrieveSeed(seeds, {0.09F, -0.04F, 1.0F}), &seeds[0]);
    EXPECT_EQ(retrieveSeed(seeds, {0.3F, -0.05F, 2.5F}), &seeds[1]);
    EXPECT_EQ(retrieveSeed({}, {0.1F, 0.0F, 1.0F}), nullptr);
}

/// The law of a label with these exponents of the level over speed and force and of the frequency.
class RangeLawTest : public ::testing::Test {
protected:
    [[nodiscard]] RangedMotion ranged(const std::array<double, 3>& exponents, const std::array<float, 2>& velocityMps,
                                      float forceNewtons, float spatialScale = 1.0F) const {
        const Material material{.embedding = {},
                                .speedLevelExponent = exponents[0],
                                .forceLevelExponent = exponents[1],
                                .frequencyExponent = exponents[2]};
        return applyRangeLaw(model_.header(), material, velocityMps, forceNewtons, spatialScale);
    }

    model::ModelFile model_ = testing::smallModel();
};

TEST_F(RangeLawTest, InsideTheRangeNothingChanges) {
    const RangedMotion inside = ranged({1.0, 0.5, 1.0}, {0.3F, -0.2F}, 2.0F);
    EXPECT_EQ(inside.motion, (std::array<float, 3>{0.3F, -0.2F, 2.0F}));
    EXPECT_EQ(inside.levelGain, 1.0);
    EXPECT_EQ(inside.readingRate, 1.0);
}

TEST_F(RangeLawTest, BeyondTheRangeTheMotionIsClampedInItsDirection) {
    const RangedMotion beyond = ranged({}, {1.2F, 1.6F}, 8.0F);
    EXPECT_NEAR(std::hypot(beyond.motion[0], beyond.motion[1]), 0.4, 1e-6);
    EXPECT_NEAR(beyond.motion[1] / beyond.motion[0], 4.0 / 3.0, 1e-5);
    EXPECT_FLOAT_EQ(beyond.motion[2], 4.0F);
}

TEST_F(RangeLawTest, LevelAndReadingRateFollowTheLabelsExponentsUpToALimit) {
    const RangedMotion beyond = ranged({1.0, 0.5, 0.5}, {0.8F, 0.0F}, 16.0F);
    EXPECT_NEAR(beyond.levelGain, 2.0 * 2.0, 1e-6);
    EXPECT_NEAR(beyond.readingRate, std::sqrt(2.0), 1e-6);
    const RangedMotion farBeyond = ranged({2.0, 1.0, 1.0}, {20.0F, 0.0F}, 1000.0F);
    EXPECT_EQ(farBeyond.levelGain, 16.0);
    EXPECT_EQ(farBeyond.readingRate, 4.0);
}

TEST_F(RangeLawTest, ASlowSweepAcrossTheEdgeOfTheRangeHasNoStep) {
    RangedMotion last = ranged({0.97, 0.21, 1.0}, {}, 0.0F);
    for (int i = 1; i <= 20000; ++i) {
        const float share = static_cast<float>(i) / 20000.0F;
        const RangedMotion next = ranged({0.97, 0.21, 1.0}, {2.0F * share, 0.0F}, 10.0F * share);
        ASSERT_LE(std::abs(next.levelGain - last.levelGain), 1e-3);
        ASSERT_LE(std::abs(next.readingRate - last.readingRate), 1e-3);
        ASSERT_LE(std::abs(next.motion[0] - last.motion[0]), 1e-3F);
        ASSERT_LE(std::abs(next.motion[2] - last.motion[2]), 1e-3F);
        last = next;
    }
}

TEST_F(RangeLawTest, OnASurfaceOfAnotherScaleTheNetworkUsesTheScaledSpeedAndTheLevelTheActualOne) {
    constexpr std::array<double, 3> half{0.5, 0.25, 0.5};
    const RangedMotion larger = ranged(half, {0.08F, -0.06F}, 1.0F, 2.0F);
    EXPECT_FLOAT_EQ(larger.motion[0], 0.04F);
    EXPECT_FLOAT_EQ(larger.motion[1], -0.03F);
    EXPECT_FLOAT_EQ(larger.levelMotion[0], 0.08F);
    EXPECT_FLOAT_EQ(larger.levelMotion[1], -0.06F);
    EXPECT_EQ(larger.levelGain, 1.0);
    EXPECT_EQ(larger.readingRate, 1.0);
    const RangedMotion smaller = ranged(half, {0.4F, 0.0F}, 1.0F, 0.25F);
    EXPECT_FLOAT_EQ(smaller.motion[0], 0.4F);
    EXPECT_NEAR(smaller.levelGain, 1.0, 1e-6) << "the actual speed is within the range";
    EXPECT_NEAR(smaller.readingRate, 2.0, 1e-6);
    const RangedMotion fast = ranged(half, {0.8F, 0.0F}, 1.0F, 2.0F);
    EXPECT_NEAR(fast.readingRate, 1.0, 1e-6) << "half the speed is within the range";
    EXPECT_NEAR(fast.levelGain, std::sqrt(2.0), 1e-6);
}

}  // namespace
}  // namespace haptoflow::engine
