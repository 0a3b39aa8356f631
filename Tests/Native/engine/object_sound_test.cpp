#include "../model/material_builder.hpp"
#include "../skeleton/skeleton_model.hpp"
#include "engine/material.hpp"
#include "engine/offline_renderer.hpp"
#include "inference/skeleton_generator.hpp"
#include "simulated_device.hpp"
#include "small_library.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <random>
#include <span>
#include <utility>
#include <vector>

// What a variation of the object is heard as: in a single label, in a blend, and where the object changes.

namespace haptoflow::engine {
namespace {

using haptoflow::testing::levelDecibels;
using testing::SimulatedDevice;

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
    static TimedContactState slideAt(double seconds, std::uint32_t seed, float variation,
                                     const std::vector<std::pair<std::uint32_t, float>>& blend = {{0U, 1.0F}}) {
        TimedContactState state;
        static_cast<ContactState&>(state) = testing::sliding();
        state.timeSeconds = seconds;
        state.material = {};
        for (const auto& [label, weight] : blend) {
            state.material.add(label, weight);
        }
        state.hasPlace = 1;
        state.surfaceSeed = seed;
        state.placeMetres = {static_cast<float>(0.1 * seconds), 0.0F, 0.0F};
        state.firstAxis = {1.0F, 0.0F, 0.0F};
        state.secondAxis = {0.0F, 1.0F, 0.0F};
        state.variation = variation;
        return state;
    }
    static std::vector<float> rendered(const model::ModelFile& model, std::uint32_t seed, float variation) {
        inference::SkeletonGenerator generator(skeleton::readNativeParts(model), 4);
        std::vector<TimedContactState> states;
        states.reserve(36);
        for (int update = 0; update < 36; ++update) {
            states.push_back(slideAt(update / 72.0, seed, variation));
        }
        return renderOffline(model, generator, states, {}).samples;
    }

    /// What the worker is told of a state.
    WorkerMessage published(const ContactState& state) {
        SimulatedDevice device(model_, skeleton_);
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

TEST_F(ObjectSoundTest, OneObjectSoundsTheSameInEverySessionAndMoreVariationDiffersMore) {
    const std::vector<float> mean = rendered(model_, 9, 0.0F);
    const auto distance = [&mean](const std::vector<float>& samples) {
        std::vector<float> difference(mean.size());
        std::ranges::transform(mean, samples, difference.begin(), std::minus<>());
        return levelDecibels(difference);
    };
    EXPECT_EQ(rendered(model_, 9, 1.0F), rendered(model_, 9, 1.0F));
    EXPECT_LT(distance(rendered(model_, 9, 0.1F)), distance(rendered(model_, 9, 0.3F)));
    EXPECT_LT(distance(rendered(model_, 9, 0.3F)), distance(rendered(model_, 9, 1.0F)));
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
    const std::vector<std::pair<std::uint32_t, float>> half{{0U, 0.5F}, {1U, 0.5F}};
    const WorkerMessage mean = published(slideAt(0.0, 7, 0.0F, half));
    const WorkerMessage drawn = published(slideAt(0.0, 7, 1.0F, half));
    const ObjectIdentity object{.surfaceSeed = 7, .variation = 1.0F};
    ASSERT_EQ(drawn.blend.count, 2U);
    for (std::uint32_t label = 0; label < 2; ++label) {
        EXPECT_EQ(drawn.blend.parts[label].embedding, embeddingOf(material(label), object));
        EXPECT_NE(drawn.blend.parts[label].embedding, mean.blend.parts[label].embedding);
    }
    for (std::size_t j = 0; j < model::textureSize; ++j) {
        EXPECT_NEAR(drawn.material.embedding[j],
                    0.5F * (drawn.blend.parts[0].embedding[j] + drawn.blend.parts[1].embedding[j]), 1e-5F);
    }
    EXPECT_EQ(drawn.material.level.levelMps2, mean.material.level.levelMps2);
}

TEST_F(ObjectSoundTest, AChangeOfTheObjectWithinATouchMakesNoClick) {
    // Every quarter of a second, between two objects or between an object and the mean.
    constexpr double period = 0.25;
    constexpr int changes = 600;
    constexpr float speedMps = 0.0937F;
    const std::array<std::array<std::pair<std::uint32_t, float>, 2>, 2> cases{
        {{{{7U, 1.0F}, {7U, 0.0F}}}, {{{7U, 1.0F}, {8U, 1.0F}}}}};
    for (const auto& objects : cases) {
        testing::DeviceSettings settings;
        settings.blockFrames = 96;
        settings.updateHz = 100.0;
        SimulatedDevice device(model_, skeleton_, settings);
        device.run(changes * period, [&](double seconds) {
            const auto [seed, variation] = objects[static_cast<std::size_t>(seconds / period + 1e-6) % 2];
            // No whole number of ribs in a period.
            TimedContactState state = slideAt(seconds, seed, variation);
            state.velocityMps[0] = speedMps;
            state.placeMetres[0] = static_cast<float>(seconds * static_cast<double>(speedMps));
            return state;
        });
        // Mean squares of the steps from sample to sample: of each of the 10 ms after a change, for a click would
        // always come at the same one, and within each object.
        const std::vector<float>& wave = device.waveform.samples;
        const auto squaredStep = [&wave](std::size_t sample) {
            const double step = static_cast<double>(wave[sample + 1]) - static_cast<double>(wave[sample]);
            return step * step;
        };
        constexpr std::size_t followed = 22;
        std::array<std::array<double, followed>, 2> atChange{};
        std::array<double, 2> within{};
        for (int change = 1; change < changes; ++change) {
            const auto first = static_cast<std::size_t>(change * period * 2000.0);
            const auto object = static_cast<std::size_t>(change % 2);
            for (std::size_t after = 0; after < followed; ++after) {
                atChange[object][after] += squaredStep(first - 2 + after);
            }
            for (std::size_t later = 300; later < 480; ++later) {
                within[object] += squaredStep(first + later) / 180.0;
            }
        }
        const double loudest = 10.0 * std::log10(std::max(within[0], within[1]));
        for (const auto& each : atChange) {
            EXPECT_LT(10.0 * std::log10(std::ranges::max(each)), loudest + 1.8);
        }
        EXPECT_EQ(device.counters().onsets, 1U) << "one touch";
    }
}

}  // namespace
}  // namespace haptoflow::engine
