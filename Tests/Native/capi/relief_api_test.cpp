#include "open_engine.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace haptoflow::capi::testing {
namespace {

using ::testing::HasSubstr;

/// A tile of 32 mm with ribs of 0.1 mm across the columns, 2 mm apart.
struct Ribs {
    static constexpr uint32_t texels = 128;
    std::vector<float> heightsMetres;
    haptoflow_relief_options options{};

    Ribs() {
        for (uint32_t texel = 0; texel < texels * texels; ++texel) {
            const double turns = 16.0 * (static_cast<double>(texel % texels) + 0.5) / texels;
            heightsMetres.push_back(static_cast<float>(1e-4 * (1.0 + std::cos(2.0 * std::numbers::pi * turns))));
        }
        options = {.struct_size = sizeof(options),
                   .columns = texels,
                   .rows = texels,
                   .is_tiled = 1,
                   .heights_metres = heightsMetres.data(),
                   .size_metres = {0.032F, 0.032F},
                   .depth_metres = 2e-4F,
                   .tip_radius_metres = 0.0F};
    }
};

class ReliefApiTest : public ::testing::Test {
protected:
    void SetUp() override { EXPECT_EQ(haptoflow_relief_create(&rough.options, &felt), HAPTOFLOW_OK) << message(); }
    void TearDown() override { EXPECT_EQ(haptoflow_relief_destroy(&felt), HAPTOFLOW_OK) << message(); }

    /// A tip that slides along the first axis, over a relief without texture.
    [[nodiscard]] haptoflow_contact_state over(double seconds, float alongMps = 0.1F) const {
        haptoflow_contact_state state = slidingState(alongMps);
        state.effects = HAPTOFLOW_ASKS_FOR_RELIEF;
        state.relief = felt;
        state.relief_place[0] = alongMps * static_cast<float>(seconds) / 0.032F;
        state.relief_share = 1.0F;
        return state;
    }
    std::vector<float> slide(int updates, auto&& change) {
        return opened.play(updates, [&](int update) {
            haptoflow_contact_state state = over(667.0 * update / 48000.0);
            change(state);
            return state;
        });
    }
    std::vector<float> slide(int updates) {
        return slide(updates, [](haptoflow_contact_state&) {});
    }
    [[nodiscard]] haptoflow_effect_statistics statistics() const { return opened.effect(HAPTOFLOW_EFFECT_RELIEF); }

    Ribs rough;
    haptoflow_relief felt = 0;
    OpenEngine opened{tinyModelPath};
};

TEST_F(ReliefApiTest, RibsAreHeardAtTheRateAtWhichTheTipCrossesThemInMetresPerSecondSquared) {
    const std::vector<float> output = slide(72);
    // 100 mm/s over 2 mm: 50 Hz, above the resonance on the label's 600 N/m.
    const double amplitude = HAPTOFLOW_DEFAULT_FULL_SCALE_MPS2 *
                             haptoflow::testing::amplitudeAt(std::span(output).last(24000), 50.0, 48000.0);
    // An ideal tip's A (2 pi v / L)^2 is 9.9.
    EXPECT_NEAR(amplitude, 8.2, 1.0);
    EXPECT_GT(statistics().samples, 24000U);
    EXPECT_EQ(statistics().is_asked_for, 1U);
}

TEST_F(ReliefApiTest, ASurfaceWithoutReliefRunsNothingOfIt) {
    const std::vector<float> output = slide(10, [](haptoflow_contact_state& state) { state.relief = 0; });
    EXPECT_EQ(peak(output), 0.0F);
    (void)slide(10, [](haptoflow_contact_state& state) { state.effects = HAPTOFLOW_ASKS_FOR_TEXTURE; });
    EXPECT_EQ(statistics().runs + statistics().prepared, 0U);
}

TEST_F(ReliefApiTest, ItKeepsToItsShareOfTheFullScale) {
    const auto peakWith = [this](float share) {
        // Without what fades of another share.
        (void)slide(1, [](haptoflow_contact_state& state) { state.relief = 0; });
        return peak(slide(36, [share](haptoflow_contact_state& state) {
            state.relief_share = share;
            state.velocity_mps[0] = 0.4F;
            state.relief_place[0] *= 4.0F;
        }));
    };
    EXPECT_LE(peakWith(0.2F), 0.2F);
    EXPECT_GT(peakWith(0.2F), 0.1F);
    EXPECT_EQ(peakWith(0.0F), 0.0F);
}

TEST_F(ReliefApiTest, LiftOffMuteAndPanicSilenceItAndTheNextTouchSounds) {
    EXPECT_GT(peak(slide(10)), 0.04F);
    (void)opened.update(liftedState());
    EXPECT_EQ(peak(opened.update(liftedState())), 0.0F);
    const auto touched = [](uint32_t touch) {
        return [touch](haptoflow_contact_state& state) { state.touch_counter = touch; };
    };
    EXPECT_GT(peak(slide(10, touched(2))), 0.04F);
    EXPECT_EQ(haptoflow_voice_set_muted(opened.voice, 1), HAPTOFLOW_OK);
    (void)slide(2, touched(2));
    EXPECT_EQ(peak(slide(5, touched(2))), 0.0F);
    EXPECT_EQ(haptoflow_voice_set_muted(opened.voice, 0), HAPTOFLOW_OK);
    EXPECT_GT(peak(slide(10, touched(2))), 0.04F);
    EXPECT_EQ(haptoflow_voice_panic(opened.voice), HAPTOFLOW_OK);
    (void)slide(2, touched(2));
    EXPECT_EQ(peak(slide(5, touched(2))), 0.0F);
    EXPECT_GT(peak(slide(10, touched(3))), 0.04F);
    // Without states it falls silent as all does.
    (void)opened.render(9600);
    EXPECT_EQ(peak(opened.render(960)), 0.0F);
}

TEST_F(ReliefApiTest, OneThatIsDestroyedUnderTheTipFadesWithTheNextStateAndItsNumberIsRefused) {
    EXPECT_GT(peak(slide(10)), 0.04F);
    haptoflow_relief copy = felt;
    EXPECT_EQ(haptoflow_relief_destroy(&felt), HAPTOFLOW_OK);
    EXPECT_EQ(felt, 0U);
    EXPECT_GT(peak(opened.render(64)), 0.0F) << "the newest state still plays";
    const auto gone = [copy](haptoflow_contact_state& state) { state.relief = copy; };
    (void)slide(1, gone);
    EXPECT_EQ(peak(slide(5, gone)), 0.0F);
    EXPECT_EQ(haptoflow_relief_destroy(&copy), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_EQ(haptoflow_relief_create(&rough.options, &felt), HAPTOFLOW_OK) << message();
    EXPECT_NE(felt, copy);
    EXPECT_GT(peak(slide(10)), 0.04F);
}

TEST_F(ReliefApiTest, StatesWithNumbersThatAreNotFiniteAreCountedAndStayBounded) {
    for (const float wild : {std::nanf(""), INFINITY, -INFINITY, 1e30F}) {
        const std::vector<float> output = slide(20, [wild, n = 0](haptoflow_contact_state& state) mutable {
            const std::array fields{&state.relief_place[0], &state.relief_place[1], &state.relief_share};
            *fields.at(static_cast<std::size_t>(n++ % 3)) = wild;
        });
        EXPECT_TRUE(allFinite(output));
        EXPECT_LE(peak(output), 1.0F);
    }
    EXPECT_GE(opened.statistics().sanitised, 80U);
}

TEST_F(ReliefApiTest, OptionsOutOfRangeAreRefusedByName) {
    const auto refusal = [this](auto change) {
        haptoflow_relief_options options = rough.options;
        change(options);
        haptoflow_relief relief = 7;
        EXPECT_EQ(haptoflow_relief_create(&options, &relief), HAPTOFLOW_INVALID_ARGUMENT);
        EXPECT_EQ(relief, 7U);
        return message();
    };
    EXPECT_THAT(refusal([](auto& o) { o.columns = o.rows = UINT32_MAX; }), HasSubstr("texels"));
    EXPECT_THAT(refusal([](auto& o) { o.heights_metres = nullptr; }), HasSubstr("heights_metres"));
    EXPECT_THAT(refusal([](auto& o) { o.depth_metres = 0.0F; }), HasSubstr("depth"));
    EXPECT_THAT(refusal([](auto& o) { o.size_metres[0] = std::nanf(""); }), HasSubstr("size"));
    EXPECT_THAT(refusal([](auto& o) { o.tip_radius_metres = 1.0F; }), HasSubstr("radius"));
}

TEST_F(ReliefApiTest, NormalsBecomeHeightsAndWrongSizesAreRefused) {
    std::array<float, std::size_t{3} * 64> normals{};
    for (std::size_t texel = 0; texel < 64; ++texel) {
        normals[3 * texel] =
            static_cast<float>(std::sin(2.0 * std::numbers::pi * (static_cast<double>(texel % 8) + 0.5) / 8.0));
        normals[3 * texel + 2] = 1.0F;
    }
    std::array<float, 64> heights{};
    const std::array sizeMetres{0.008F, 0.008F};
    ASSERT_EQ(haptoflow_relief_heights_of_normals(normals.data(), 8, 8, sizeMetres.data(), 1, heights.data()),
              HAPTOFLOW_OK);
    // The integral of a sine, whose amplitude is the wavelength over 2 pi, at the middles of texels.
    EXPECT_NEAR(peak(heights), 2.0 * 0.008 / (2.0 * std::numbers::pi) * std::cos(std::numbers::pi / 8.0), 1e-5);
    EXPECT_EQ(haptoflow_relief_heights_of_normals(normals.data(), 0, 8, sizeMetres.data(), 1, heights.data()),
              HAPTOFLOW_INVALID_ARGUMENT);
}

}  // namespace
}  // namespace haptoflow::capi::testing
