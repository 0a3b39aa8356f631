// Blends of the shipped model, rendered in closed loop.

#include "engine/material.hpp"
#include "engine/offline_renderer.hpp"
#include "model/model_file.hpp"
#include "simulated_device.hpp"
#include "small_library.hpp"
#include "support/model_generator.hpp"
#include "support/wave_measures.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <initializer_list>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

// A blend has whole wave vectors of its materials, not means, and each keeps its slot.

namespace haptoflow::engine {
namespace {

using skeleton::WaveVector;
using testing::SmallLibrary;

constexpr WaveVector none{};
constexpr WaveVector coarse{0.2F, 0.0F};
constexpr WaveVector fine{0.35F, 0.0F};
constexpr WaveVector across{0.0F, 0.7F};

/// A library of three labels: one without ribs, one with the ribs `coarse`, and one with `fine` and `across`.
SmallLibrary ruledLibrary() {
    model::testing::ModelBuilder builder;
    nlohmann::json third = builder.header["labels"][0];
    third["name"] = "jute";
    third["embedding_row"] = 2;
    builder.header["labels"].push_back(third);
    std::vector<float> rows(3 * model::embeddingSize, 0.5F);
    const std::array<WaveVectors, 3> vectors{{{none, none}, {coarse, none}, {fine, across}}};
    for (std::size_t row = 0; row < vectors.size(); ++row) {
        setWaveVectors(std::span(rows).subspan(row * 64).first<64>(), vectors[row]);
    }
    builder.blobs[0].shape = {3, model::embeddingSize};
    builder.blobs[0].bytes = model::testing::bytesOf(rows);
    return SmallLibrary(model::ModelFile::parse(builder.build()));
}

class BlendRibsTest : public ::testing::Test {
protected:
    [[nodiscard]] WaveVectors ribsOf(std::initializer_list<testing::LabelWeight> entries,
                                     const WaveVectors& before = {}) const {
        return assignRibs(small_.ingredients(entries), before);
    }

    SmallLibrary small_ = ruledLibrary();
};

TEST_F(BlendRibsTest, ABlendOfAPlainAndARuledLabelKeepsTheWaveVector) {
    EXPECT_EQ(ribsOf({{0, 0.5F}, {1, 0.5F}}), (WaveVectors{coarse, none}));
    EXPECT_EQ(ribsOf({{0, 0.9F}, {1, 0.1F}}), (WaveVectors{coarse, none}));
    EXPECT_EQ(ribsOf({{0, 0.5F}, {2, 0.5F}}), (WaveVectors{fine, across}));
}

TEST_F(BlendRibsTest, TheHeaviestMaterialsWaveVectorsAreKeptIfSlotsAreMissing) {
    EXPECT_EQ(ribsOf({{1, 0.6F}, {2, 0.4F}}), (WaveVectors{coarse, fine}));
    EXPECT_EQ(ribsOf({{1, 0.4F}, {2, 0.6F}}), (WaveVectors{fine, across}));
}

TEST_F(BlendRibsTest, ARibKeepsItsSlotThroughASweepBetweenTwoRuledLabels) {
    WaveVectors before{coarse, none};
    for (int step = 1; step < 100; ++step) {
        const float share = 0.01F * static_cast<float>(step);
        const WaveVectors now = ribsOf({{1, 1.0F - share}, {2, share}}, before);
        for (std::size_t slot = 0; slot < now.size(); ++slot) {
            if (!before[slot].isNone() && std::ranges::find(now, before[slot]) != now.end()) {
                ASSERT_EQ(now[slot], before[slot]) << "slot " << slot << " at a share of " << share;
            }
        }
        before = now;
    }
    EXPECT_EQ(before, (WaveVectors{across, fine}));
}

class BlendSoundTest : public ::testing::Test {
protected:
    [[nodiscard]] testing::LabelWeight part(const std::string& label, float weight) const {
        return {static_cast<std::uint32_t>(std::ranges::find(model_.header().labels, label, &model::Label::name) -
                                           model_.header().labels.begin()),
                weight};
    }

    /// The waveform played while a tip slides over a blend, without the touch-down.
    std::vector<float> played(const std::vector<testing::LabelWeight>& blend, std::array<float, 2> velocityMps,
                              double seconds) {
        const auto states = testing::statesOf(seconds, [&](double) {
            ContactState state = testing::sliding();
            state.velocityMps = velocityMps;
            state.material = testing::blendOf(blend);
            return state;
        });
        std::vector<float> wave =
            renderOffline(model_, *generator_, states, {.fullScaleMps2 = 1e5F, .tailSeconds = 0.0}).waveformMps2;
        wave.erase(wave.begin(), wave.begin() + 400);
        return wave;
    }

    /// The share of the power within 2 % of a frequency.
    static double shareOfLine(const std::vector<float>& wave, double frequencyHz) {
        double line = 0.0;
        double whole = 0.0;
        for (double hz = 4.0; hz < 990.0; hz += 0.5) {
            std::complex<double> sum = 0.0;
            const std::complex<double> step = std::polar(1.0, -2.0 * std::numbers::pi * hz / 2000.0);
            std::complex<double> turn = 1.0;
            for (const float sample : wave) {
                sum += static_cast<double>(sample) * turn;
                turn *= step;
            }
            whole += std::norm(sum);
            line += std::abs(hz - frequencyHz) <= 0.02 * frequencyHz ? std::norm(sum) : 0.0;
        }
        return line / whole;
    }

    model::ModelFile model_ = model::ModelFile::read(HAPTOFLOW_TEST_DEFAULT_MODEL);
    std::unique_ptr<inference::TierGenerator> generator_ = haptoflow::testing::generatorOf(model_, 4, "draft");
};

// The balance of a blend counts noise and lines, not impulses: metal mesh with carpet at 30 mm/s lacks 1.3 dB.
TEST_F(BlendSoundTest, EveryBlendLiesBetweenItsLabelsOrAtMostTwoDecibelsBelow) {
    const std::size_t labels = model_.header().labels.size();
    for (const float speedMps : {0.03F, 0.3F}) {
        const std::array<float, 2> velocity{0.8F * speedMps, 0.6F * speedMps};
        std::vector<double> alone;
        for (std::uint32_t label = 0; label < labels; ++label) {
            alone.push_back(testing::levelDecibels(played({{label, 1.0F}}, velocity, 5.0)));
        }
        for (std::uint32_t first = 0; first < labels; ++first) {
            for (std::uint32_t second = first + 1; second < labels; ++second) {
                const double blend = testing::levelDecibels(played({{first, 0.5F}, {second, 0.5F}}, velocity, 4.0));
                const auto [softer, louder] = std::minmax(alone[first], alone[second]);
                EXPECT_GT(blend, softer - 2.0) << model_.header().labels[first].name << " and "
                                               << model_.header().labels[second].name << " at " << speedMps;
                EXPECT_LT(blend, louder + 0.5) << model_.header().labels[first].name << " and "
                                               << model_.header().labels[second].name << " at " << speedMps;
            }
        }
    }
}

TEST_F(BlendSoundTest, ABlendOfWoodAndCorduroyHasWeakerRibsOfTheSamePitch) {
    // 0.15 m/s over ribs with a period of 2.5 mm gives 60 Hz. A mean of wave vectors would give 30 Hz.
    const std::array<float, 2> velocity{0.15F, 0.0F};
    const double pure = shareOfLine(played({part("corduroy", 1.0F)}, velocity, 4.0), 60.0);
    const std::vector<float> blend = played({part("wood", 0.5F), part("corduroy", 0.5F)}, velocity, 4.0);
    const double half = shareOfLine(blend, 60.0);
    const double wood = shareOfLine(played({part("wood", 1.0F)}, velocity, 4.0), 60.0);
    EXPECT_GT(half, 2.0 * wood) << "the ribs are present";
    EXPECT_LT(half, 0.9 * pure) << "the ribs are weaker";
    EXPECT_GT(half, 3.0 * shareOfLine(blend, 30.0)) << "there are no ribs at half the pitch";
}

}  // namespace
}  // namespace haptoflow::engine
