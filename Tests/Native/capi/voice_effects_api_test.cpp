#include "open_engine.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string>

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

TEST_F(VoiceEffectsApiTest, ALandingThatRequestsItsImpactIsRenderedAndCounted) {
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

TEST_F(VoiceEffectsApiTest, AVoiceUsesOnlyTheProcessorsThatWereSet) {
    EXPECT_EQ(haptoflow_voice_set_delay(open_.voice, 0.01), HAPTOFLOW_OK) << message();
    EXPECT_EQ(haptoflow_voice_set_actuator(open_.voice, "voice-coil", 10), HAPTOFLOW_OK) << message();
    for (int update = 0; update < 20; ++update) {
        (void)open_.update(slidingState());
    }
    for (const haptoflow_effect effect : {HAPTOFLOW_EFFECT_DELAY, HAPTOFLOW_EFFECT_COMPENSATION}) {
        EXPECT_EQ(of(effect).prepared, 1U) << effect;
        EXPECT_EQ(of(effect).is_asked_for, 1U);
        EXPECT_GT(of(effect).runs, 10U);
    }
    EXPECT_EQ(of(HAPTOFLOW_EFFECT_EXPOSURE_GUARD).prepared, 0U);
    EXPECT_EQ(haptoflow_voice_set_delay(open_.voice, 0.0), HAPTOFLOW_OK);
    EXPECT_EQ(haptoflow_voice_set_actuator(open_.voice, nullptr, 0), HAPTOFLOW_OK);
    for (int update = 0; update < 5; ++update) {
        (void)open_.update(slidingState());
    }
    const uint64_t runs = of(HAPTOFLOW_EFFECT_DELAY).runs;
    (void)open_.update(slidingState());
    EXPECT_EQ(of(HAPTOFLOW_EFFECT_DELAY).runs, runs) << "a processor that is switched off does not run";
    EXPECT_EQ(of(HAPTOFLOW_EFFECT_DELAY).is_asked_for, 0U);
}

TEST_F(VoiceEffectsApiTest, AnInvalidProfileIsRefusedByKeyAndTheOldOneStays) {
    EXPECT_EQ(haptoflow_voice_set_actuator(open_.voice, "voice-coil", 10), HAPTOFLOW_OK);
    const std::string broken = R"({"name": "x"})";
    EXPECT_EQ(haptoflow_voice_set_actuator(open_.voice, broken.data(), broken.size()), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_THAT(message(), ::testing::HasSubstr("profile: "));
    EXPECT_EQ(haptoflow_voice_set_actuator(open_.voice, "loudspeaker", 11), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_EQ(of(HAPTOFLOW_EFFECT_COMPENSATION).is_asked_for, 1U);
}

TEST_F(VoiceEffectsApiTest, DelayAndGuardOutOfRangeAreRefusedByName) {
    for (const double seconds : {-0.1, 0.6, std::numeric_limits<double>::quiet_NaN()}) {
        EXPECT_EQ(haptoflow_voice_set_delay(open_.voice, seconds), HAPTOFLOW_INVALID_ARGUMENT);
        EXPECT_THAT(message(), ::testing::HasSubstr("expected 0 to 0.5"));
    }
    for (const float gain : {-1.0F, 1e9F, std::numeric_limits<float>::quiet_NaN()}) {
        EXPECT_EQ(haptoflow_voice_set_exposure_guard(open_.voice, 1, gain), HAPTOFLOW_INVALID_ARGUMENT);
    }
}

TEST_F(VoiceEffectsApiTest, TheExposureOfAVoiceWithoutAGuardIsZeroWithAGainOfOne) {
    haptoflow_exposure exposure{};
    exposure.struct_size = sizeof(exposure);
    EXPECT_EQ(haptoflow_voice_exposure(open_.voice, &exposure), HAPTOFLOW_OK);
    EXPECT_EQ(exposure.gain, 1.0);
    EXPECT_EQ(exposure.daily_mps2, 0.0);
    EXPECT_EQ(haptoflow_voice_set_exposure_guard(open_.voice, 1, 0.0F), HAPTOFLOW_OK);
    for (int update = 0; update < 40; ++update) {
        (void)open_.update(slidingState());
    }
    EXPECT_EQ(haptoflow_voice_exposure(open_.voice, &exposure), HAPTOFLOW_OK);
    EXPECT_EQ(exposure.reason, HAPTOFLOW_EXPOSURE_NONE);
    EXPECT_EQ(exposure.gain, 1.0);
    EXPECT_GT(exposure.daily_mps2, 0.0);
    EXPECT_LT(exposure.daily_mps2, 0.1);
}

TEST_F(VoiceEffectsApiTest, ASignalReplacesAllEffectsWhileTheTipMovesAndItsStartsAndStopsAreCounted) {
    ASSERT_EQ(haptoflow_voice_set_delay(open_.voice, 0.01), HAPTOFLOW_OK) << message();
    ASSERT_EQ(haptoflow_voice_set_signal(open_.voice, 200.0, 6.0), HAPTOFLOW_OK) << message();
    haptoflow_contact_state state = landing(HAPTOFLOW_ASKS_FOR_TEXTURE | HAPTOFLOW_ASKS_FOR_IMPACT);
    for (int update = 0; update < 5; ++update) {
        EXPECT_EQ(peak(open_.update(state)), 0.0F);
    }
    state.velocity_mps[0] = 0.15F;
    for (int update = 0; update < 5; ++update) {
        (void)open_.update(state);
    }
    EXPECT_NEAR(peak(open_.update(state)), 6.0F / static_cast<float>(HAPTOFLOW_DEFAULT_FULL_SCALE_MPS2), 1e-3F);
    state.touching = 0;
    for (int update = 0; update < 5; ++update) {
        (void)open_.update(state);
    }
    EXPECT_EQ(peak(open_.update(state)), 0.0F);
    for (const haptoflow_effect effect : {HAPTOFLOW_EFFECT_TEXTURE, HAPTOFLOW_EFFECT_IMPACT, HAPTOFLOW_EFFECT_EDGE}) {
        EXPECT_EQ(of(effect).prepared + of(effect).runs + of(effect).samples + of(effect).events, 0U) << effect;
        EXPECT_EQ(of(effect).is_asked_for, 0U) << effect;
    }
    EXPECT_EQ(open_.statistics().inferences, 0U);
    EXPECT_EQ(of(HAPTOFLOW_EFFECT_SIGNAL).is_asked_for, 1U);
    EXPECT_EQ(of(HAPTOFLOW_EFFECT_SIGNAL).events, 1U);
    EXPECT_GT(of(HAPTOFLOW_EFFECT_SIGNAL).samples, 3000U);
    haptoflow_signal_statistics cycles{};
    cycles.struct_size = sizeof(cycles);
    ASSERT_EQ(haptoflow_voice_signal_statistics(open_.voice, &cycles), HAPTOFLOW_OK) << message();
    EXPECT_EQ(cycles.starts, 1U);
    EXPECT_EQ(cycles.stops, 1U);
    EXPECT_GT(cycles.last_start_latency_seconds, 0.01) << "the delay and the time until the callback";
    EXPECT_GT(cycles.last_stop_latency_seconds, 0.01);
    EXPECT_EQ(cycles.mean_start_latency_seconds, cycles.last_start_latency_seconds);
    EXPECT_EQ(cycles.mean_stop_latency_seconds, cycles.last_stop_latency_seconds);
}

TEST_F(VoiceEffectsApiTest, ASignalOutOfRangeIsRefusedByNameAndTheOldOneStays) {
    ASSERT_EQ(haptoflow_voice_set_signal(open_.voice, 20.0, 60.0), HAPTOFLOW_OK) << message();
    const double none = std::numeric_limits<double>::quiet_NaN();
    for (const double frequencyHz : {0.0, 19.9, 500.1, none, std::numeric_limits<double>::infinity()}) {
        EXPECT_EQ(haptoflow_voice_set_signal(open_.voice, frequencyHz, 1.0), HAPTOFLOW_INVALID_ARGUMENT);
        EXPECT_THAT(message(), ::testing::HasSubstr("frequency_hz is "));
    }
    for (const double amplitudeMps2 : {-0.1, 60.1, none}) {
        EXPECT_EQ(haptoflow_voice_set_signal(open_.voice, 200.0, amplitudeMps2), HAPTOFLOW_INVALID_ARGUMENT);
        EXPECT_THAT(message(), ::testing::HasSubstr("amplitude_mps2 is "));
    }
    EXPECT_EQ(of(HAPTOFLOW_EFFECT_SIGNAL).is_asked_for, 1U);
    EXPECT_EQ(haptoflow_voice_set_signal(999, 200.0, 1.0), HAPTOFLOW_INVALID_ARGUMENT);
    haptoflow_signal_statistics cycles{};
    cycles.struct_size = sizeof(cycles);
    EXPECT_EQ(haptoflow_voice_signal_statistics(999, &cycles), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_EQ(haptoflow_voice_signal_statistics(open_.voice, nullptr), HAPTOFLOW_INVALID_ARGUMENT);
}

TEST_F(VoiceEffectsApiTest, AnUnknownEffectIsRefusedByName) {
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
