#include "engine/material.hpp"
#include "engine/rib_phase.hpp"
#include "small_library.hpp"

#include <gtest/gtest.h>

#include <array>
#include <vector>

// A blend has whole wave vectors of its materials, not means, and each keeps its phase.

namespace haptoflow::engine {
namespace {

using testing::SmallLibrary;

constexpr WaveVector none{};
constexpr WaveVector coarse{0.2F, 0.0F};
constexpr WaveVector fine{0.35F, 0.0F};
constexpr WaveVector across{0.0F, 0.7F};

/// A library of three labels: without ribs, with `coarse`, and with `fine` and `across`.
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

TEST_F(BlendRibsTest, APhaseFollowsItsWaveVectorToAnotherSlot) {
    const RibTurns phases{0.1, 0.6};
    EXPECT_EQ(phasesFor({fine, none}, {coarse, fine}, phases), (RibTurns{0.6, 0.6}));
    EXPECT_EQ(phasesFor({across, fine}, {fine, across}, phases), (RibTurns{0.6, 0.1}));
    EXPECT_EQ(phasesFor({coarse, fine}, {coarse, fine}, phases), phases);
    EXPECT_EQ(phasesFor({across, none}, {coarse, none}, phases), phases) << "new ribs get the phase of their slot";
}

TEST_F(BlendRibsTest, NoPhaseJumpsDuringASweepBetweenTwoRuledLabels) {
    RibTrack track;
    track.begin(0, {.phase = {0.3, 0.0}, .turnsPerSample = {0.01, 0.0}, .vectors = {coarse, none}});
    constexpr std::int64_t hop = 28;
    WaveVectors before{coarse, none};
    std::array<double, 3> travelled{0.3, 0.0, 0.0};
    const std::array<WaveVector, 3> all{coarse, fine, across};
    std::array<bool, 3> isKnown{true, false, false};
    for (int step = 0; step <= 100; ++step) {
        const float share = 0.01F * static_cast<float>(step);
        const WaveVectors vectors = ribsOf({{1, 1.0F - share}, {2, share}}, before);
        const RibTurns phases = track.at(step * hop, vectors);
        for (std::size_t rib = 0; rib < all.size(); ++rib) {
            const auto slot = std::ranges::find(vectors, all[rib]) - vectors.begin();
            if (slot == 2) {
                isKnown[rib] = false;
                continue;
            }
            const double phase = phases[static_cast<std::size_t>(slot)];
            if (isKnown[rib]) {
                const double gap = phase - travelled[rib];
                ASSERT_NEAR(gap, std::round(gap), 1e-4) << "rib " << rib << " at a share of " << share;
            }
            isKnown[rib] = true;
            // The tip moves at 0.1 m/s along x and 0.05 m/s along y.
            const double turns =
                (static_cast<double>(all[rib].x) * 100.0 + static_cast<double>(all[rib].y) * 50.0) / 2000.0;
            travelled[rib] = phase + turns * static_cast<double>(hop);
        }
        std::array<float, model::embeddingSize> embedding{};
        setWaveVectors(embedding, vectors);
        track.add(step * hop, vectors, phases, ribTurnsPerSample(embedding, 0.1, 0.05));
        before = vectors;
    }
}

}  // namespace
}  // namespace haptoflow::engine
