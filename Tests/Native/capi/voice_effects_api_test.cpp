#include "open_engine.hpp"

#include "effects/wave_features.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

namespace haptoflow::capi::testing {
namespace {

class VoiceEffectsApiTest : public ::testing::Test {
protected:
    [[nodiscard]] haptoflow_effect_statistics of(haptoflow_effect effect) const { return open_.effect(effect); }

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
    (void)open_.play(20);
    for (const haptoflow_effect effect : {HAPTOFLOW_EFFECT_DELAY, HAPTOFLOW_EFFECT_COMPENSATION}) {
        EXPECT_EQ(of(effect).prepared, 1U) << effect;
        EXPECT_EQ(of(effect).is_asked_for, 1U);
        EXPECT_GT(of(effect).runs, 10U);
    }
    EXPECT_EQ(of(HAPTOFLOW_EFFECT_EXPOSURE_GUARD).prepared, 0U);
    EXPECT_EQ(haptoflow_voice_set_delay(open_.voice, 0.0), HAPTOFLOW_OK);
    EXPECT_EQ(haptoflow_voice_set_actuator(open_.voice, nullptr, 0), HAPTOFLOW_OK);
    (void)open_.play(5);
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
    auto exposure = sized<haptoflow_exposure>();
    EXPECT_EQ(haptoflow_voice_exposure(open_.voice, &exposure), HAPTOFLOW_OK);
    EXPECT_EQ(exposure.gain, 1.0);
    EXPECT_EQ(exposure.daily_mps2, 0.0);
    EXPECT_EQ(haptoflow_voice_set_exposure_guard(open_.voice, 1, 0.0F), HAPTOFLOW_OK);
    (void)open_.play(40);
    EXPECT_EQ(haptoflow_voice_exposure(open_.voice, &exposure), HAPTOFLOW_OK);
    EXPECT_EQ(exposure.reason, HAPTOFLOW_EXPOSURE_NONE);
    EXPECT_EQ(exposure.gain, 1.0);
    EXPECT_GT(exposure.daily_mps2, 0.0);
    EXPECT_LT(exposure.daily_mps2, 0.1);
}

TEST_F(VoiceEffectsApiTest, ASignalReplacesTheTextureAndItsStartsAndStopsAreCounted) {
    ASSERT_EQ(haptoflow_voice_set_delay(open_.voice, 0.01), HAPTOFLOW_OK) << message();
    ASSERT_EQ(haptoflow_voice_set_signal(open_.voice, 200.0, 6.0), HAPTOFLOW_OK) << message();
    (void)open_.update(liftedState(0));
    (void)open_.play(5);
    EXPECT_NEAR(peak(open_.update(slidingState())), 6.0F / static_cast<float>(HAPTOFLOW_DEFAULT_FULL_SCALE_MPS2),
                1e-3F);
    (void)open_.play(5, liftedState());
    EXPECT_EQ(of(HAPTOFLOW_EFFECT_TEXTURE).is_asked_for, 0U);
    EXPECT_EQ(of(HAPTOFLOW_EFFECT_SIGNAL).is_asked_for, 1U);
    EXPECT_EQ(of(HAPTOFLOW_EFFECT_SIGNAL).events, 1U);
    auto cycles = sized<haptoflow_signal_statistics>();
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
    auto cycles = sized<haptoflow_signal_statistics>();
    EXPECT_EQ(haptoflow_voice_signal_statistics(999, &cycles), HAPTOFLOW_INVALID_ARGUMENT);
}

TEST_F(VoiceEffectsApiTest, AnUnknownEffectIsRefusedByName) {
    auto statistics = sized<haptoflow_effect_statistics>();
    for (const haptoflow_effect effect : {-1, HAPTOFLOW_EFFECT_COUNT, INT32_MAX}) {
        EXPECT_EQ(haptoflow_voice_effect_statistics(open_.voice, effect, &statistics), HAPTOFLOW_INVALID_ARGUMENT);
        EXPECT_THAT(message(), ::testing::HasSubstr("effect is " + std::to_string(effect)));
    }
    EXPECT_EQ(haptoflow_voice_effect_statistics(999, HAPTOFLOW_EFFECT_EDGE, &statistics), HAPTOFLOW_INVALID_ARGUMENT);
}

/// A sine of 150 Hz whose amplitude swells twice per second.
std::vector<float> swellingTone(double rateHz, double seconds) {
    std::vector<float> wave(static_cast<std::size_t>(rateHz * seconds));
    for (std::size_t i = 0; i < wave.size(); ++i) {
        const double time = static_cast<double>(i) / rateHz;
        const double envelope = 3.0 + 2.0 * std::sin(2.0 * std::numbers::pi * 2.0 * time);
        wave[i] = static_cast<float>(envelope * std::sin(2.0 * std::numbers::pi * 150.0 * time));
    }
    return wave;
}

class WaveFeaturesApiTest : public ::testing::Test {
protected:
    static haptoflow_wave_features_options options(uint32_t sampleRateHz = 0, double frameSeconds = 0.0) {
        return {sizeof(haptoflow_wave_features_options), sampleRateHz, frameSeconds, 0.0, 0.0};
    }

    void create(const haptoflow_wave_features_options& options) {
        ASSERT_EQ(haptoflow_wave_features_create(&options, features_.out()), HAPTOFLOW_OK) << message();
    }

    std::vector<haptoflow_wave_frame> process(const std::vector<float>& wave, std::size_t block, uint64_t room = 32) {
        std::vector<haptoflow_wave_frame> all;
        std::vector<haptoflow_wave_frame> taken(room);
        for (std::size_t i = 0; i < wave.size(); i += block) {
            uint64_t count = 0;
            EXPECT_EQ(haptoflow_wave_features_process(features_, wave.data() + i, std::min(block, wave.size() - i),
                                                      taken.data(), taken.size(), &count),
                      HAPTOFLOW_OK)
                << message();
            all.insert(all.end(), taken.begin(), taken.begin() + static_cast<std::ptrdiff_t>(count));
        }
        return all;
    }

    Handle<haptoflow_wave_features, haptoflow_wave_features_close> features_;
};

TEST_F(WaveFeaturesApiTest, FramesEqualThoseOfTheEffectsLibrary) {
    const std::vector<float> wave = swellingTone(2000.0, 1.0);
    create(options(0, 0.005));
    const auto taken = process(wave, 37);
    effects::WaveFeatures own;
    std::vector<effects::WaveFrame> expected(own.framesWithin(wave.size()));
    expected.resize(own.process(wave, expected).frames);
    ASSERT_EQ(taken.size(), expected.size());
    ASSERT_GE(taken.size(), 195U);
    for (std::size_t i = 0; i < taken.size(); ++i) {
        EXPECT_EQ(taken[i].first_sample, expected[i].firstSample);
        EXPECT_EQ(taken[i].sample_count, expected[i].sampleCount);
        EXPECT_EQ(taken[i].intensity, expected[i].intensity);
        EXPECT_EQ(taken[i].frequency_hz, expected[i].frequencyHz);
        EXPECT_EQ(taken[i].amplitude_mps2, expected[i].amplitudeMps2);
        EXPECT_EQ(taken[i].transient_amplitude_mps2, expected[i].transient.amplitudeMps2);
    }
}

TEST_F(WaveFeaturesApiTest, ADeviceWithOneFrequencyGetsItFromTheNextFrameOn) {
    create(options());
    (void)process(swellingTone(2000.0, 0.2), 400);
    ASSERT_EQ(haptoflow_wave_features_set_range(features_, 216.0, 216.0), HAPTOFLOW_OK);
    for (const haptoflow_wave_frame& frame : process(swellingTone(2000.0, 0.2), 400, 100)) {
        EXPECT_EQ(frame.frequency_hz, 216.0F);
    }
}

TEST_F(WaveFeaturesApiTest, OptionsOutOfRangeAreRefusedByName) {
    for (const uint32_t rate : {1999U, 3000U, 44100U, 194000U}) {
        const auto wrong = options(rate);
        EXPECT_EQ(haptoflow_wave_features_create(&wrong, features_.out()), HAPTOFLOW_INVALID_ARGUMENT);
        EXPECT_THAT(message(), ::testing::HasSubstr("sample_rate_hz"));
    }
    const auto shortFrames = options(0, 0.001);
    EXPECT_EQ(haptoflow_wave_features_create(&shortFrames, features_.out()), HAPTOFLOW_INVALID_ARGUMENT);
    auto range = options();
    range.minimum_frequency_hz = 300.0;
    range.maximum_frequency_hz = 200.0;
    EXPECT_EQ(haptoflow_wave_features_create(&range, features_.out()), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_EQ(features_, nullptr);
    create(options());
    EXPECT_EQ(haptoflow_wave_features_set_range(features_, 0.0, 100.0), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_EQ(haptoflow_wave_features_set_range(features_, std::numeric_limits<double>::quiet_NaN(), 100.0),
              HAPTOFLOW_INVALID_ARGUMENT);
}

using DeviceWaveHandle = Handle<haptoflow_device_wave, haptoflow_device_wave_close>;

TEST(DeviceLoudnessApiTest, AKindOrRateOrFullScaleOutOfRangeIsRefusedByName) {
    float share = 0.0F;
    for (const haptoflow_device_kind kind : {-1, 3, INT32_MAX}) {
        EXPECT_EQ(haptoflow_device_share(kind, 1.0F, &share), HAPTOFLOW_INVALID_ARGUMENT);
        EXPECT_THAT(message(), ::testing::HasSubstr("expected 0 to 2"));
    }
    DeviceWaveHandle wave;
    EXPECT_EQ(haptoflow_device_wave_create(1000.0, wave.out()), HAPTOFLOW_INVALID_ARGUMENT);
    ASSERT_EQ(haptoflow_device_wave_create(8000.0, wave.out()), HAPTOFLOW_OK) << message();
    float sample = 0.5F;
    for (const float scale : {0.0F, -1.0F, INFINITY, std::nanf("")}) {
        EXPECT_EQ(haptoflow_device_wave_process(wave, &sample, 1, scale), HAPTOFLOW_INVALID_ARGUMENT);
        EXPECT_EQ(sample, 0.5F);
    }
}

TEST(DeviceLoudnessApiTest, TheFullScaleOfTheWaveDoesNotChangeWhatIsPlayed) {
    std::vector<float> whole = swellingTone(8000.0, 0.5);
    std::vector<float> scaled = whole;
    std::ranges::for_each(scaled, [](float& sample) { sample /= 200.0F; });
    DeviceWaveHandle wave;
    ASSERT_EQ(haptoflow_device_wave_create(8000.0, wave.out()), HAPTOFLOW_OK) << message();
    EXPECT_EQ(haptoflow_device_wave_process(wave, whole.data(), whole.size(), 1.0F), HAPTOFLOW_OK);
    EXPECT_EQ(haptoflow_device_wave_reset(wave), HAPTOFLOW_OK);
    EXPECT_EQ(haptoflow_device_wave_process(wave, scaled.data(), scaled.size(), 200.0F), HAPTOFLOW_OK);
    for (std::size_t i = 0; i < whole.size(); ++i) {
        ASSERT_NEAR(whole[i], scaled[i], 1e-5F) << i;
    }
}

}  // namespace
}  // namespace haptoflow::capi::testing
