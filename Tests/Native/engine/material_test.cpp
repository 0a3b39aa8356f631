#include "engine/material.hpp"

#include "small_library.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

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
}

TEST(SeedRetrievalTest, TheSeedRecordedNearestToTheMotionIsChosen) {
    const testing::SmallLibrary small;
    const auto& seeds = small.ingredients({{0, 1.0F}}).heaviest().material->seeds;
    // "oak" has seeds recorded at (0.1, -0.05) m/s and 1 N, and at (0.2, -0.05) m/s and 2 N.
    EXPECT_EQ(retrieveSeed(seeds, {0.09F, -0.04F, 1.0F}), &seeds[0]);
    EXPECT_EQ(retrieveSeed(seeds, {0.3F, -0.05F, 2.5F}), &seeds[1]);
}

TEST(SeedRetrievalTest, AMaterialWithoutSeedsGivesNull) {
    EXPECT_EQ(retrieveSeed({}, {0.1F, 0.0F, 1.0F}), nullptr);
}

}  // namespace
}  // namespace haptoflow::engine
