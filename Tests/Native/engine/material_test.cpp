// A label with its own level and tone is added to the shipped model.

#include "engine/material.hpp"

#include "engine/offline_renderer.hpp"
#include "model/material_builder.hpp"
#include "model/model_builder.hpp"
#include "model/model_file.hpp"
#include "simulated_device.hpp"
#include "small_library.hpp"
#include "support/model_generator.hpp"
#include "support/wave_measures.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string>
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
        ContactState state = testing::sliding();
        state.hasPlace = 1;
        state.placeMetres = {1.0F, 2.0F, 3.0F};
        state.firstAxis = {1.0F, 0.0F, 0.0F};
        state.secondAxis = {0.0F, 1.0F, 0.0F};
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

/// The shipped model with one more label, which has a slightly changed embedding of wood and its own level and tone.
model::ModelFile withDenim(const model::ModelFile& shipped) {
    model::testing::ModelBuilder builder;
    builder.header = nlohmann::json::parse(shipped.headerText());
    builder.header.erase("blobs");
    builder.blobs.clear();
    for (const model::Blob& blob : shipped.header().blobs) {
        const auto bytes = shipped.blob(blob.name);
        model::testing::BlobContent content{blob.name, blob.type == model::BlobType::onnx ? "onnx" : "float32",
                                            blob.shape, model::testing::Bytes(bytes.begin(), bytes.end())};
        if (blob.name == "embedding") {
            std::vector<float> row(shipped.embedding(0).begin(), shipped.embedding(0).end());
            row[0] += 0.1F;
            const model::testing::Bytes added = model::testing::bytesOf(row);
            content.bytes.insert(content.bytes.end(), added.begin(), added.end());
            ++content.shape[0];
        }
        if (blob.name == "pieces") {
            content.bytes.resize(content.bytes.size() + bytes.size() / static_cast<std::size_t>(content.shape[0]));
            ++content.shape[0];
        }
        builder.blobs.push_back(content);
    }
    nlohmann::json denim = model::testing::validMaterial("00000000");
    denim["embedding_row"] = shipped.header().labels.size();
    builder.header["labels"].push_back(denim);
    return model::ModelFile::parse(builder.build());
}

class AddedLabelTest : public ::testing::Test {
protected:
    static std::vector<float> rendered(const model::ModelFile& model, std::uint32_t first, std::uint32_t second) {
        const auto generator = haptoflow::testing::generatorOf(model, 4, "draft");
        const auto states = testing::statesOf(1.0, [&](double seconds) {
            ContactState state = testing::sliding();
            state.velocityMps = {0.1F, 0.05F};
            state.material = testing::blendOf({{seconds < 0.5 ? first : second, 1.0F}});
            return state;
        });
        return renderOffline(model, *generator, states, {}).samples;
    }

    model::ModelFile shipped_ = model::ModelFile::read(HAPTOFLOW_TEST_DEFAULT_MODEL);
    model::ModelFile added_ = withDenim(shipped_);
};

TEST_F(AddedLabelTest, AnAddedLabelDoesNotChangeTheOutputOfOtherLabels) {
    EXPECT_EQ(model::spaceOf(added_.header()), model::spaceOf(shipped_.header()));
    for (const std::uint32_t label : {0U, 8U, 13U}) {
        const std::vector<float> before = rendered(shipped_, label, label + 1);
        EXPECT_GT(haptoflow::testing::peak(before), 0.0F);
        EXPECT_EQ(rendered(added_, label, label + 1), before) << label;
    }
}

TEST_F(AddedLabelTest, AnAddedLabelSoundsAtItsOwnLevel) {
    const auto denim = static_cast<std::uint32_t>(shipped_.header().labels.size());
    const std::vector<float> own = rendered(added_, denim, denim);
    // At 0.112 m/s and 1 N, the level is e^1.08 m/s^2 plus 3 dB; the tone adds 1 to 9 dB.
    const double decibels = haptoflow::testing::levelDecibels(std::span(own).first(48000)) + 20.0 * std::log10(200.0);
    EXPECT_GT(decibels, 20.0 * std::log10(std::exp(1.08)) + 3.0 - 4.0);
    EXPECT_LT(decibels, 20.0 * std::log10(std::exp(1.08)) + 3.0 + 9.0);
}

}  // namespace
}  // namespace haptoflow::engine
