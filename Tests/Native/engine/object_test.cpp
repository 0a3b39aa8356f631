#include "engine/material.hpp"
#include "engine/offline_renderer.hpp"
#include "inference/skeleton_generator.hpp"
#include "inference/skeleton_model.hpp"
#include "model/file_layout.hpp"
#include "model/material_builder.hpp"
#include "simulated_device.hpp"
#include "skeleton/condition.hpp"
#include "skeleton/skeleton_tensors.hpp"
#include "small_library.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

// Objects of one label differ as the recorded pieces of that label did: by an offset of the embedding that the object's
// seed draws.

namespace haptoflow::engine {
namespace {

using Embedding = std::array<float, model::embeddingSize>;

constexpr std::size_t textureSize = model::textureSize;

model::ModelFile goldenModel() {
    return model::ModelFile::read(HAPTOFLOW_TEST_GOLDEN_DIR "/model/skeleton.haptoflow");
}

class ObjectEmbeddingTest : public ::testing::Test {
protected:
    [[nodiscard]] Embedding embedding(std::size_t label, ObjectIdentity object) const {
        return embeddingOf(*ingredient(label).material, object);
    }
    [[nodiscard]] Ingredient ingredient(std::size_t label) const {
        return small_.ingredients({{static_cast<std::uint32_t>(label), 1.0F}}).entries[0];
    }
    [[nodiscard]] std::size_t pieces() const { return small_.model.pieceOffsets(0).size() / textureSize; }

    [[nodiscard]] double covarianceOfPieces(std::size_t label, std::size_t i, std::size_t j) const {
        const auto offsets = small_.model.pieceOffsets(label);
        double sum = 0.0;
        for (std::size_t s = 0; s < pieces(); ++s) {
            sum +=
                static_cast<double>(offsets[s * textureSize + i]) * static_cast<double>(offsets[s * textureSize + j]);
        }
        return sum / static_cast<double>(pieces() - 1);
    }

    testing::SmallLibrary small_{goldenModel()};
};

TEST_F(ObjectEmbeddingTest, TwoSeedsDifferAndOneSeedNeverDoes) {
    const testing::SmallLibrary another(goldenModel());
    for (std::uint32_t seed = 0; seed < 200; ++seed) {
        const Embedding here = embedding(1, {seed, 1.0F});
        EXPECT_EQ(here, embeddingOf(*another.ingredients({{1, 1.0F}}).entries[0].material, {seed, 1.0F}));
        EXPECT_NE(here, embedding(1, {seed + 1, 1.0F}));
    }
}

TEST_F(ObjectEmbeddingTest, ASeedMakesTheSameObjectOnEveryPlatform) {
    std::vector<float> numbers;
    for (const std::uint32_t seed : {0U, 1U, 123'456'789U}) {
        std::ranges::copy(embedding(0, {seed, 0.7F}), std::back_inserter(numbers));
    }
    // As first drawn, on Linux x64.
    EXPECT_EQ(model::crc32(model::testing::bytesOf(numbers)), 1'970'460'742U);
}

TEST_F(ObjectEmbeddingTest, ManyObjectsHaveTheMeanAndTheCovarianceOfTheRecordedPieces) {
    constexpr std::uint32_t objects = 20'000;
    for (const float variation : {1.0F, 0.3F}) {
        std::array<double, textureSize> mean{};
        std::vector<double> products(textureSize * textureSize);
        for (std::uint32_t seed = 0; seed < objects; ++seed) {
            const Embedding drawn = embedding(0, {seed, variation});
            std::array<double, textureSize> offset{};
            for (std::size_t j = 0; j < textureSize; ++j) {
                offset[j] = static_cast<double>(drawn[j]) - static_cast<double>(small_.model.embedding(0)[j]);
                mean[j] += offset[j] / objects;
            }
            for (std::size_t i = 0; i < textureSize; ++i) {
                for (std::size_t j = 0; j < textureSize; ++j) {
                    products[i * textureSize + j] += offset[i] * offset[j] / objects;
                }
            }
        }
        const double scale = static_cast<double>(variation) * static_cast<double>(variation);
        for (std::size_t i = 0; i < textureSize; ++i) {
            const double own = scale * covarianceOfPieces(0, i, i);
            EXPECT_NEAR(mean[i], 0.0, 4.5 * std::sqrt(own / objects)) << i;
            for (std::size_t j = 0; j < textureSize; ++j) {
                const double wanted = scale * covarianceOfPieces(0, i, j);
                const double samplingError =
                    std::sqrt((own * scale * covarianceOfPieces(0, j, j) + wanted * wanted) / objects);
                EXPECT_NEAR(products[i * textureSize + j], wanted, 4.5 * samplingError) << i << ", " << j;
            }
        }
    }
}

TEST(ObjectWithoutPiecesTest, AModelWithoutRecordedPiecesHasNoVariation) {
    const testing::SmallLibrary small;
    EXPECT_TRUE(small.model.pieceOffsets(0).empty());
    const Ingredients alone = small.ingredients({{1, 1.0F}});
    EXPECT_TRUE(std::ranges::equal(embeddingOf(*alone.entries[0].material, {5, 1.0F}), small.model.embedding(1)));
}

// What a variation of the object is heard as: in a single label, in a blend, and where the object changes.

/// A calm model, whose labels were recorded from eight pieces each.
model::testing::ModelBuilder modelOfPieces() {
    constexpr std::size_t pieces = 8;
    auto builder = skeleton::testing::skeletonModel({.seed = 5, .strength = 0.3F});
    std::mt19937 random(17);
    std::normal_distribution<float> normal(0.0F, 0.5F);
    std::vector<float> offsets(2 * pieces * model::textureSize);
    std::ranges::generate(offsets, [&] { return normal(random); });
    for (std::size_t label = 0; label < 2; ++label) {
        for (std::size_t j = 0; j < model::textureSize; ++j) {
            float mean = 0.0F;
            for (std::size_t s = 0; s < pieces; ++s) {
                mean += offsets[(label * pieces + s) * model::textureSize + j] / pieces;
            }
            for (std::size_t s = 0; s < pieces; ++s) {
                offsets[(label * pieces + s) * model::textureSize + j] -= mean;
            }
        }
    }
    builder.blobs.push_back({"pieces", "float32", {2, pieces, 60}, model::testing::bytesOf(offsets)});
    return builder;
}

class ObjectSoundTest : public ::testing::Test {
protected:
    static ContactState slideAt(double seconds, std::uint32_t seed, float variation,
                                const std::vector<testing::LabelWeight>& blend = {{0U, 1.0F}}) {
        ContactState state = testing::slidingAt(0.1 * seconds);
        state.material = testing::blendOf(blend);
        state.surfaceSeed = seed;
        state.variation = variation;
        return state;
    }
    static std::vector<float> rendered(const model::ModelFile& model, std::uint32_t seed, float variation) {
        inference::SkeletonGenerator generator(skeleton::readNativeParts(model), 4);
        const auto states = testing::statesOf(0.5, [&](double seconds) { return slideAt(seconds, seed, variation); });
        return renderOffline(model, generator, states, {}).samples;
    }

    /// What the worker is told of a state.
    ContactMessage published(const ContactState& state) {
        testing::SimulatedDevice device(model_, skeleton_);
        device.voice().publisher.publish(state);
        EXPECT_TRUE(device.voice().channels.toWorker.fetch());
        return device.voice().channels.toWorker.current();
    }
    [[nodiscard]] const PreparedMaterial& material(std::uint32_t label) const {
        return *MaterialLibrary::ReadScope(library_).ingredients(testing::blendOf({{label, 1.0F}})).entries[0].material;
    }

    model::ModelFile model_ = skeleton::testing::read(modelOfPieces());
    skeleton::NativeParts native_ = skeleton::readNativeParts(model_);
    inference::SkeletonGenerator skeleton_{native_, 4};
    MaterialLibrary library_{model_, skeleton_};
};

TEST_F(ObjectSoundTest, WithoutVariationEverySampleIsThatOfAModelThatDoesNotTellPiecesApart) {
    auto builder = modelOfPieces();
    builder.blobs.pop_back();
    const model::ModelFile without = skeleton::testing::read(builder);
    for (const std::uint32_t seed : {0U, 9U}) {
        EXPECT_EQ(rendered(model_, seed, 0.0F), rendered(without, seed, 0.0F));
        EXPECT_EQ(rendered(without, seed, 0.0F), rendered(without, seed, 1.0F));
    }
}

TEST_F(ObjectSoundTest, ASingleLabelHasTheLevelThatTheModelGivesTheObject) {
    std::vector<float> levels;
    for (const std::uint32_t seed : {1U, 2U, 3U}) {
        const MaterialInputs inputs = published(slideAt(0.0, seed, 1.0F)).material;
        const ObjectIdentity object{.surfaceSeed = seed, .variation = 1.0F};
        EXPECT_EQ(inputs.embedding, embeddingOf(material(0), object));
        EXPECT_FALSE(inputs.level.levelMps2) << "the level model computes it from the embedding";
        levels.push_back(native_.level->logLevel(inputs.embedding, inputs.level.motion));
    }
    EXPECT_NE(levels[0], levels[1]);
    EXPECT_NE(levels[1], levels[2]);
}

TEST_F(ObjectSoundTest, ABlendHasItsIngredientsOffsetsAndTheLevelOfItsLabels) {
    const std::vector<testing::LabelWeight> half{{0U, 0.5F}, {1U, 0.5F}};
    const ContactMessage mean = published(slideAt(0.0, 7, 0.0F, half));
    const ContactMessage drawn = published(slideAt(0.0, 7, 1.0F, half));
    const ObjectIdentity object{.surfaceSeed = 7, .variation = 1.0F};
    EXPECT_NE(drawn.material.embedding, mean.material.embedding);
    for (std::size_t j = 0; j < model::textureSize; ++j) {
        EXPECT_NEAR(drawn.material.embedding[j],
                    0.5F * (embeddingOf(material(0), object)[j] + embeddingOf(material(1), object)[j]), 1e-5F);
    }
    EXPECT_EQ(drawn.material.level.levelMps2, mean.material.level.levelMps2);
}

}  // namespace
}  // namespace haptoflow::engine
