
#include "../model/material_builder.hpp"
#include "../skeleton/skeleton_model.hpp"
#include "engine/material.hpp"
#include "model/file_layout.hpp"
#include "skeleton/condition.hpp"
#include "skeleton/skeleton_tensors.hpp"
#include "small_library.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstdint>
#include <functional>
#include <limits>
#include <numbers>
#include <span>
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

/// Mean and standard deviation.
struct Spread {
    double mean = 0.0;
    double deviation = 0.0;
};

Spread spreadOf(std::span<const double> values) {
    Spread spread;
    for (const double value : values) {
        spread.mean += value / static_cast<double>(values.size());
    }
    for (const double value : values) {
        spread.deviation += (value - spread.mean) * (value - spread.mean) / static_cast<double>(values.size() - 1);
    }
    spread.deviation = std::sqrt(spread.deviation);
    return spread;
}

TEST(VariationStateTest, AVariationIsLimitedToZeroToOneAndCorrectionsAreCounted) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    ContactState state;
    EXPECT_EQ(state.variation, 0.0F);
    for (const auto& [given, expected] : {std::pair{-0.5F, 0.0F},
                                          {1.5F, 1.0F},
                                          {infinity, 0.0F},
                                          {-infinity, 0.0F},
                                          {std::numeric_limits<float>::quiet_NaN(), 0.0F}}) {
        state.variation = given;
        EXPECT_EQ(sanitise(state), 1U) << given;
        EXPECT_EQ(state.variation, expected) << given;
    }
    state.variation = 0.25F;
    EXPECT_EQ(sanitise(state), 0U);
    EXPECT_EQ(state.variation, 0.25F);
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

    /// The embedding of a recorded piece.
    [[nodiscard]] Embedding piece(std::size_t label, std::size_t index) const {
        Embedding whole{};
        std::ranges::copy(small_.model.embedding(label), whole.begin());
        for (std::size_t j = 0; j < textureSize; ++j) {
            whole[j] += small_.model.pieceOffsets(label)[index * textureSize + j];
        }
        return whole;
    }
    [[nodiscard]] double covarianceOfPieces(std::size_t label, std::size_t i, std::size_t j) const {
        const auto offsets = small_.model.pieceOffsets(label);
        double sum = 0.0;
        for (std::size_t s = 0; s < pieces(); ++s) {
            sum +=
                static_cast<double>(offsets[s * textureSize + i]) * static_cast<double>(offsets[s * textureSize + j]);
        }
        return sum / static_cast<double>(pieces() - 1);
    }

    /// Expects that a figure of objects is spread as that of the recorded pieces.
    void expectSpreadOfPieces(const std::function<double(const Embedding&)>& figure) const {
        for (std::size_t label = 0; label < 2; ++label) {
            std::vector<double> ofPieces;
            for (std::size_t s = 0; s < pieces(); ++s) {
                ofPieces.push_back(figure(piece(label, s)));
            }
            std::vector<double> ofObjects;
            for (std::uint32_t seed = 0; seed < 2000; ++seed) {
                ofObjects.push_back(figure(embedding(label, {seed, 1.0F})));
            }
            const Spread recorded = spreadOf(ofPieces);
            const Spread drawn = spreadOf(ofObjects);
            EXPECT_GT(drawn.deviation, 0.7 * recorded.deviation) << label;
            EXPECT_LT(drawn.deviation, 1.4 * recorded.deviation) << label;
            EXPECT_NEAR(drawn.mean, recorded.mean, 0.4 * recorded.deviation) << label;
            // A resonance answers an offset more than in proportion, so a few objects lie further off than that.
            const double lowest = std::ranges::min(ofPieces) - recorded.deviation;
            const double highest = std::ranges::max(ofPieces) + recorded.deviation;
            const auto near =
                std::ranges::count_if(ofObjects, [&](double value) { return value > lowest && value < highest; });
            EXPECT_GT(near, static_cast<std::ptrdiff_t>(0.93 * static_cast<double>(ofObjects.size()))) << label;
            for (const double value : ofObjects) {
                EXPECT_LT(std::abs(value - recorded.mean), 7.0 * recorded.deviation) << label << ": no freaks";
            }
        }
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
    EXPECT_EQ(model::crc32(model::testing::bytesOf(numbers)), 3'827'620'593U);
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

TEST_F(ObjectEmbeddingTest, TheLevelOfObjectsIsSpreadAsThatOfTheRecordedPieces) {
    const auto level = skeleton::readLevelModel(small_.model);
    for (const float speedMps : {0.02F, 0.1F, 0.5F}) {
        expectSpreadOfPieces([&](const Embedding& each) { return level->logLevel(each, {speedMps, 0.0F, 1.0F}); });
    }
}

TEST_F(ObjectEmbeddingTest, ABlendsIngredientsHaveTheirOwnOffsetsByTheirWeights) {
    const ObjectIdentity object{.surfaceSeed = 11, .variation = 0.8F};
    const Material mixed = resolveMaterial(small_.ingredients({{0, 3.0F}, {1, 1.0F}}), {}, object);
    const Embedding first = embedding(0, object);
    const Embedding second = embedding(1, object);
    for (std::size_t j = 0; j < textureSize; ++j) {
        EXPECT_NEAR(mixed.embedding[j], 0.75F * first[j] + 0.25F * second[j], 1e-6F);
    }
    EXPECT_EQ(waveVectorsOf(mixed.embedding), waveVectorsOf(small_.model.embedding(1)));
}

TEST(ObjectWithoutPiecesTest, AModelWithoutRecordedPiecesHasNoVariation) {
    const testing::SmallLibrary small;
    EXPECT_TRUE(small.model.pieceOffsets(0).empty());
    const Ingredients alone = small.ingredients({{1, 1.0F}});
    EXPECT_TRUE(std::ranges::equal(embeddingOf(*alone.entries[0].material, {5, 1.0F}), small.model.embedding(1)));
}

}  // namespace
}  // namespace haptoflow::engine
