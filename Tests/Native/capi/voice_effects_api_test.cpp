#include "open_engine.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstring>
#include <vector>

namespace haptoflow::capi::testing {
namespace {

class VoiceEffectsApiTest : public ::testing::Test {
protected:
    haptoflow_effect_statistics of(haptoflow_effect effect) {
        haptoflow_effect_statistics statistics{};
        statistics.struct_size = sizeof(statistics);
        EXPECT_EQ(haptoflow_voice_effect_statistics(open_.voice, effect, &statistics), HAPTOFLOW_OK) << message();
        return statistics;
    }

    static haptoflow_contact_state landing(uint32_t effects) {
        haptoflow_contact_state state = slidingState(0.0F);
        state.approach_speed_mps = 0.3F;
        state.effects = effects;
        return state;
    }

    OpenEngine open_{tinyModelPath};
};

TEST_F(VoiceEffectsApiTest, ALandingThatAsksForItsImpactIsFeltAndCounted) {
    EXPECT_EQ(peak(open_.update(landing(0))), 0.0F) << "0 is the texture alone";
    EXPECT_EQ(of(HAPTOFLOW_EFFECT_IMPACT).events, 0U);
    haptoflow_contact_state state = landing(HAPTOFLOW_ASKS_FOR_TEXTURE | HAPTOFLOW_ASKS_FOR_IMPACT);
    state.touch_counter = 2;
    EXPECT_GT(peak(open_.update(state)), 0.01F);
    const haptoflow_effect_statistics impact = of(HAPTOFLOW_EFFECT_IMPACT);
    EXPECT_EQ(impact.events, 1U);
    EXPECT_EQ(impact.is_asked_for, 1U);
    EXPECT_EQ(impact.prepared, 1U);
    EXPECT_GT(impact.runs, 0U);
    EXPECT_GT(impact.samples, 600U);
    EXPECT_GT(impact.microseconds, 0.0);
    const haptoflow_effect_statistics edge = of(HAPTOFLOW_EFFECT_EDGE);
    EXPECT_EQ(edge.prepared + edge.runs + edge.samples + edge.events + edge.is_asked_for, 0U);
}

TEST_F(VoiceEffectsApiTest, AProgramOfAnEarlierHeaderHearsTheTextureAloneWhateverLiesBehindItsState) {
    struct {
        haptoflow_contact_state state;
    } memory{};
    memory.state = landing(HAPTOFLOW_ASKS_FOR_IMPACT);
    memory.state.struct_size = offsetof(haptoflow_contact_state, effects);
    EXPECT_EQ(peak(open_.update(memory.state)), 0.0F);
    memory.state.velocity_mps[0] = 0.2F;
    EXPECT_GT(peak(open_.update(memory.state)), 0.0F);
    EXPECT_EQ(of(HAPTOFLOW_EFFECT_IMPACT).runs, 0U);
    EXPECT_GT(of(HAPTOFLOW_EFFECT_TEXTURE).runs, 0U);
}

TEST_F(VoiceEffectsApiTest, ASurfaceThatAsksForNothingIsSilentAndCostsNothing) {
    haptoflow_contact_state state = slidingState(0.3F);
    state.approach_speed_mps = 1.0F;
    state.effects = HAPTOFLOW_ASKS_FOR_NOTHING;
    for (int update = 0; update < 20; ++update) {
        EXPECT_EQ(peak(open_.update(state)), 0.0F);
    }
    for (haptoflow_effect effect = 0; effect < HAPTOFLOW_EFFECT_COUNT; ++effect) {
        EXPECT_EQ(of(effect).runs + of(effect).prepared, 0U) << effect;
    }
}

TEST_F(VoiceEffectsApiTest, ARimIsFeltAsOftenAsItIsCounted) {
    haptoflow_contact_state state = slidingState(0.2F);
    state.effects = HAPTOFLOW_ASKS_FOR_EDGE;
    state.edge_height_metres = 0.002F;
    for (uint32_t update = 0; update < 9; ++update) {
        state.edge_counter = update / 3;
        (void)open_.update(state);
    }
    EXPECT_EQ(of(HAPTOFLOW_EFFECT_EDGE).events, 2U);
    EXPECT_EQ(open_.statistics().inferences, 0U);
}

TEST_F(VoiceEffectsApiTest, AnEffectThatThereIsNotIsRefusedByName) {
    haptoflow_effect_statistics statistics{};
    statistics.struct_size = sizeof(statistics);
    for (const haptoflow_effect effect : {-1, HAPTOFLOW_EFFECT_COUNT, INT32_MAX}) {
        EXPECT_EQ(haptoflow_voice_effect_statistics(open_.voice, effect, &statistics), HAPTOFLOW_INVALID_ARGUMENT);
        EXPECT_THAT(message(), ::testing::HasSubstr("effect is " + std::to_string(effect)));
    }
    EXPECT_EQ(haptoflow_voice_effect_statistics(999, HAPTOFLOW_EFFECT_EDGE, &statistics), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_EQ(haptoflow_voice_effect_statistics(open_.voice, HAPTOFLOW_EFFECT_EDGE, nullptr),
              HAPTOFLOW_INVALID_ARGUMENT);
}

}  // namespace
}  // namespace haptoflow::capi::testing
