#include "engine/material.hpp"

#include "engine/seed_retrieval.hpp"
#include "engine/test_model.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace haptoflow::engine {
namespace {

MaterialBlend blend(std::initializer_list<LabelWeight> entries) {
    MaterialBlend result;
    for (const LabelWeight entry : entries) {
        result.entries.at(result.count++) = entry;
    }
    return result;
}

TEST(MaterialTest, ABlendIsTheWeightedMeanOfItsLabels) {
    const model::ModelFile model = testing::smallModel();
    const Material mixed = resolveMaterial(model, blend({{0, 3.0F}, {1, 1.0F}}));
    const auto oak = model.embedding(0);
    const auto mesh = model.embedding(1);
    for (std::size_t i = 0; i < mixed.embedding.size(); ++i) {
        ASSERT_NEAR(mixed.embedding[i], 0.75F * oak[i] + 0.25F * mesh[i], 1e-6F);
    }
    EXPECT_EQ(mixed.dominantLabel, 0U);
}

TEST(MaterialTest, UnknownLabelsAndNegativeWeightsAreLeftOut) {
    const model::ModelFile model = testing::smallModel();
    const Material result = resolveMaterial(model, blend({{99, 5.0F}, {0, -1.0F}, {1, 0.5F}}));
    EXPECT_EQ(result.dominantLabel, 1U);
    EXPECT_EQ(result.embedding[3], model.embedding(1)[3]);
}

TEST(MaterialTest, ABlendWithoutAnyWeightIsTheFirstLabel) {
    const model::ModelFile model = testing::smallModel();
    for (const MaterialBlend& empty : {MaterialBlend{}, blend({{0, 0.0F}, {1, 0.0F}}), blend({{7, 1.0F}})}) {
        EXPECT_EQ(resolveMaterial(model, empty).embedding[5], model.embedding(0)[5]);
    }
}

TEST(ContactStateTest, EveryFieldOfARuinedStateBecomesFiniteAndIsCounted) {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    constexpr float infinity = std::numeric_limits<float>::infinity();
    ContactState state;
    state.timeSeconds = std::numeric_limits<double>::quiet_NaN();
    state.velocityMps = {nan, infinity};
    state.forceNewtons = -3.0F;
    state.approachSpeedMps = nan;
    state.material.count = 900;
    state.material.entries[0].weight = nan;
    EXPECT_EQ(sanitise(state), 7U);
    EXPECT_EQ(state.velocityMps[0], 0.0F);
    EXPECT_EQ(state.velocityMps[1], 0.0F);
    EXPECT_EQ(state.forceNewtons, 0.0F);
    EXPECT_EQ(state.material.count, MaterialBlend::capacity);
    EXPECT_EQ(state.timeSeconds, 0.0);
    EXPECT_EQ(sanitise(state), 0U);
}

TEST(SeedRetrievalTest, TheSeedRecordedNearestToTheMotionIsTaken) {
    const model::ModelFile model = testing::smallModel();
    // "oak" has seeds at (0.1, -0.05) m/s and 1 N, and at (0.2, -0.05) m/s and 2 N.
    EXPECT_EQ(retrieveSeed(model, 0, {0.09F, -0.04F, 1.0F}), 0U);
    EXPECT_EQ(retrieveSeed(model, 0, {0.3F, -0.05F, 2.5F}), 1U);
}

TEST(SeedRetrievalTest, ALabelWithoutSeedsGivesNone) {
    const model::ModelFile model = testing::smallModel();
    EXPECT_EQ(retrieveSeed(model, 5, {0.1F, 0.0F, 1.0F}), std::nullopt);
}

}  // namespace
}  // namespace haptoflow::engine
