// What the shipped model does in the engine: changes of label, speeds far beyond the trained range, and a label that is
// added to it with a level and a tone of its own.

#include "engine/material.hpp"
#include "engine/offline_renderer.hpp"
#include "inference/rebuilt_model.hpp"
#include "model/material_builder.hpp"
#include "model/model_file.hpp"
#include "simulated_device.hpp"
#include "small_library.hpp"
#include "support/model_generator.hpp"
#include "support/wave_measures.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace haptoflow::engine {
namespace {

constexpr std::size_t labelSamples = 200;

class LabelChangeTest : public ::testing::TestWithParam<std::pair<const char*, const char*>> {
protected:
    [[nodiscard]] std::uint32_t labelOf(const std::string& name) const {
        const auto& labels = model_.header().labels;
        return static_cast<std::uint32_t>(std::ranges::find(labels, name, &model::Label::name) - labels.begin());
    }

    /// The waveform of a stroke that changes between two labels every 100 ms.
    [[nodiscard]] std::vector<float> alternating(std::uint32_t first, std::uint32_t second) const {
        const auto generator = haptoflow::testing::generatorOf(model_, 1, "sketch");
        const auto hand = [&](double seconds) {
            ContactState state = testing::sliding();
            state.material.labels[0] = static_cast<int>(seconds * 10.0 + 1e-6) % 2 == 0 ? first : second;
            return state;
        };
        constexpr double updateHz = 100.0;
        const auto states = testing::statesOf(16.0, hand, updateHz);
        return renderOffline(model_, *generator, states, {.fullScaleMps2 = 1e5F, .tailSeconds = 0.0}).waveformMps2;
    }

    model::ModelFile model_ = model::ModelFile::read(HAPTOFLOW_TEST_DEFAULT_MODEL);
};

TEST_P(LabelChangeTest, FiveMillisecondsAfterAChangeBothLabelsHaveTheirOwnLevel) {
    const auto [loud, quiet] = GetParam();
    const std::vector<float> wave = alternating(labelOf(loud), labelOf(quiet));
    const auto levelOf = [&](std::size_t label, std::size_t first, std::size_t last) {
        std::vector<float> gathered;
        for (std::size_t change = (2 + label) * labelSamples; change + labelSamples <= wave.size();
             change += 2 * labelSamples) {
            gathered.insert(gathered.end(), wave.begin() + static_cast<std::ptrdiff_t>(change + first),
                            wave.begin() + static_cast<std::ptrdiff_t>(change + last));
        }
        return testing::levelDecibels(gathered);
    };
    EXPECT_NEAR(levelOf(0, 10, 20), levelOf(0, 100, 200), 4.0) << loud;
    EXPECT_NEAR(levelOf(1, 10, 20), levelOf(1, 100, 200), 4.0) << quiet;
}

INSTANTIATE_TEST_SUITE_P(Pairs, LabelChangeTest,
                         ::testing::Values(std::pair{"stone", "plastic"}, std::pair{"stone", "fur"},
                                           std::pair{"sandpaper", "carpet"}, std::pair{"metal", "rubber"}));

constexpr std::array<float, inference::segmentSamples> quiet{};

class RangeSweepTest : public ::testing::Test {
protected:
    /// Level in decibels, including the range law's gain, for each motion of a sweep over a label.
    std::vector<double> levels(std::size_t label, const std::vector<std::array<float, 3>>& motions) {
        const MaterialBlend blend = testing::blendOf({{static_cast<std::uint32_t>(label), 1.0F}});
        const Material material = resolveMaterial(MaterialLibrary::ReadScope(library_).ingredients(blend));
        std::vector<inference::SegmentRequest> requests;
        std::vector<double> result;
        for (const auto& motion : motions) {
            const RangedMotion ranged = applyRangeLaw(model_.header(), material, {motion[0], motion[1]}, motion[2]);
            requests.push_back(
                {.embedding = material.embedding, .motion = ranged.motion, .previous = quiet, .noise = quiet});
            result.push_back(20.0 * std::log10(ranged.levelGain));
        }
        std::vector<float> found(requests.size());
        generator_->levels(requests, found);
        for (std::size_t i = 0; i < found.size(); ++i) {
            result[i] += 20.0 * std::log10(static_cast<double>(found[i]));
        }
        return result;
    }

    /// Geometric series from `lowest` to `highest`.
    static std::vector<double> sweep(double lowest, double highest, std::size_t count) {
        std::vector<double> values(count);
        for (std::size_t i = 0; i < count; ++i) {
            values[i] = lowest * std::pow(highest / lowest, static_cast<double>(i) / static_cast<double>(count - 1));
        }
        return values;
    }

    /// The largest change of slope between two steps, in decibels per doubling.
    static double largestKink(const std::vector<double>& decibels, double doublingsOfAStep) {
        double largest = 0.0;
        for (std::size_t i = 1; i + 1 < decibels.size(); ++i) {
            const double change = decibels[i + 1] - 2.0 * decibels[i] + decibels[i - 1];
            largest = std::max(largest, std::abs(change) / doublingsOfAStep);
        }
        return largest;
    }

    static constexpr std::size_t steps = 160;
    // The slope may change gradually. A clamp would change it by 3 to 6 dB per doubling in one step.
    static constexpr double largestAllowedKink = 2.5;

    model::ModelFile model_ = model::ModelFile::read(HAPTOFLOW_TEST_DEFAULT_MODEL);
    std::unique_ptr<inference::TierGenerator> generator_ = haptoflow::testing::generatorOf(model_, 256);
    MaterialLibrary library_{model_, *generator_};
};

TEST_F(RangeSweepTest, FromStandstillToTwoMetresASecondTheLevelHasNeitherAStepNorAKink) {
    const std::vector<double> speeds = sweep(0.004, 2.0, steps);
    std::vector<std::array<float, 3>> motions;
    for (const double speed : speeds) {
        motions.push_back({static_cast<float>(0.8 * speed), static_cast<float>(0.6 * speed), 1.0F});
    }
    for (std::size_t label = 0; label < model_.header().labels.size(); ++label) {
        const std::vector<double> decibels = levels(label, motions);
        for (std::size_t i = 1; i < decibels.size(); ++i) {
            ASSERT_LT(std::abs(decibels[i] - decibels[i - 1]), 1.0) << model_.header().labels[label].name;
        }
        EXPECT_LT(largestKink(decibels, std::log2(speeds[1] / speeds[0])), largestAllowedKink)
            << model_.header().labels[label].name;
    }
}

/// The shipped model with one more label, which has a slightly changed embedding of wood and its own level and tone.
model::ModelFile withDenim(const model::ModelFile& shipped) {
    model::testing::ModelBuilder builder = inference::testing::builderOf(shipped);
    std::vector<float> row(shipped.embedding(0).begin(), shipped.embedding(0).end());
    row[0] += 0.1F;
    const std::size_t pieceBytes = blobOf(builder, "pieces").bytes.size() / shipped.header().labels.size();
    for (const auto& [name, added] : {std::pair("embedding", model::testing::bytesOf(row)),
                                      std::pair("pieces", model::testing::Bytes(pieceBytes))}) {
        model::testing::BlobContent& blob = blobOf(builder, name);
        blob.bytes.insert(blob.bytes.end(), added.begin(), added.end());
        ++blob.shape[0];
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
        EXPECT_GT(testing::peak(before), 0.0F);
        EXPECT_EQ(rendered(added_, label, label + 1), before) << label;
    }
}

TEST_F(AddedLabelTest, AnAddedLabelSoundsAtItsOwnLevel) {
    const auto denim = static_cast<std::uint32_t>(shipped_.header().labels.size());
    const std::vector<float> own = rendered(added_, denim, denim);
    // At 0.112 m/s and 1 N, the level is e^1.08 m/s^2 plus 3 dB; the tone adds 1 to 9 dB.
    const double decibels = testing::levelDecibels(std::span(own).first(48000)) + 20.0 * std::log10(200.0);
    EXPECT_GT(decibels, 20.0 * std::log10(std::exp(1.08)) + 3.0 - 4.0);
    EXPECT_LT(decibels, 20.0 * std::log10(std::exp(1.08)) + 3.0 + 9.0);
}

}  // namespace
}  // namespace haptoflow::engine
