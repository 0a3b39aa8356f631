#include "open_engine.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace haptoflow::capi::testing {
namespace {

using ::testing::HasSubstr;

std::vector<float> hum(double seconds, double rateHz = 2000.0) {
    return haptoflow::testing::sine(150.0, 20.0, seconds, rateHz);
}

class ClipApiTest : public ::testing::Test {
protected:
    static haptoflow_clip* create(const std::vector<float>& wave, uint32_t rateHz = 0) {
        auto options = sized<haptoflow_clip_options>();
        options.sample_rate_hz = rateHz;
        options.wave_mps2 = wave.data();
        options.sample_count = wave.size();
        options.title = "hum";
        options.description = "a test";
        haptoflow_clip* clip = nullptr;
        EXPECT_EQ(haptoflow_clip_create(&options, &clip), HAPTOFLOW_OK) << message();
        return clip;
    }
    static haptoflow_clip_info describe(const haptoflow_clip* clip) {
        auto info = sized<haptoflow_clip_info>();
        EXPECT_EQ(haptoflow_clip_describe(clip, &info), HAPTOFLOW_OK) << message();
        return info;
    }
    static std::string write(const haptoflow_clip* clip, haptoflow_clip_format format) {
        uint64_t length = 0;
        EXPECT_EQ(haptoflow_clip_write(clip, format, "2026-01-02", nullptr, 0, &length), HAPTOFLOW_OK) << message();
        std::string text(length, '\0');
        EXPECT_EQ(haptoflow_clip_write(clip, format, "2026-01-02", text.data(), length, &length), HAPTOFLOW_OK);
        return text;
    }
    void play(const haptoflow_clip* clip, float gain = 1.0F, uint32_t isLoop = 0) {
        EXPECT_EQ(haptoflow_voice_play_clip(opened.voice, clip, gain, isLoop), HAPTOFLOW_OK) << message();
    }
    /// Seconds of a stylus in the air.
    std::vector<float> hover(double seconds) { return opened.play(static_cast<int>(seconds * 72.0), liftedState()); }

    OpenEngine opened{tinyModelPath};
    ClipHandle humming{create(hum(0.5))};
};

TEST_F(ClipApiTest, AWaveIsWrittenAndReadInEveryFormat) {
    for (const haptoflow_clip_format format : {HAPTOFLOW_CLIP_HAPTIC, HAPTOFLOW_CLIP_AHAP, HAPTOFLOW_CLIP_HJIF}) {
        const std::string text = write(humming, format);
        ClipHandle read;
        ASSERT_EQ(haptoflow_clip_read(text.data(), text.size(), read.out()), HAPTOFLOW_OK) << message();
        const haptoflow_clip_info info = describe(read);
        EXPECT_EQ(info.format, format);
        EXPECT_NEAR(info.duration_seconds, 0.5, 0.03);
        EXPECT_NE((std::string(info.title) + info.description).find("a test"), std::string::npos);
        std::array<float, 11> amplitude{};
        std::array<float, 11> frequency{};
        ASSERT_EQ(haptoflow_clip_curves(read, 11, amplitude.data(), frequency.data()), HAPTOFLOW_OK) << message();
        EXPECT_NEAR(frequency[5], 150.0F, 6.0F);
        EXPECT_NEAR(amplitude[5], describe(humming).largest_amplitude, 0.05F);
    }
}

TEST_F(ClipApiTest, TheWaveComesBackInMetresPerSecondSquaredAtAnyRate) {
    for (const double rateHz : {2000.0, 8000.0, 44100.0}) {
        uint64_t count = 0;
        ASSERT_EQ(haptoflow_clip_wave(humming, rateHz, nullptr, 0, &count), HAPTOFLOW_OK) << message();
        EXPECT_NEAR(static_cast<double>(count), 0.5 * rateHz, 1.0);
        std::vector<float> wave(count);
        ASSERT_EQ(haptoflow_clip_wave(humming, rateHz, wave.data(), count, &count), HAPTOFLOW_OK) << message();
        EXPECT_NEAR(*std::ranges::max_element(wave.begin() + static_cast<std::ptrdiff_t>(count / 2), wave.end()), 20.0F,
                    2.0F);
    }
}

TEST_F(ClipApiTest, AFasterWaveGivesTheSameClip) {
    const ClipHandle fast(create(hum(0.5, 48000.0), 48000));
    std::array<float, 9> slowCurve{};
    std::array<float, 9> fastCurve{};
    EXPECT_EQ(haptoflow_clip_curves(humming, 9, slowCurve.data(), nullptr), HAPTOFLOW_OK);
    EXPECT_EQ(haptoflow_clip_curves(fast, 9, fastCurve.data(), nullptr), HAPTOFLOW_OK);
    for (std::size_t i = 1; i < 8; ++i) {
        EXPECT_NEAR(fastCurve[i], slowCurve[i], 0.02F) << i;
    }
}

TEST_F(ClipApiTest, WhatIsNoClipIsRefusedWithTheKey) {
    haptoflow_clip* read = nullptr;
    const std::string text = R"({"version":{"major":3},"signals":{}})";
    EXPECT_EQ(haptoflow_clip_read(text.data(), text.size(), &read), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_THAT(message(), HasSubstr("version.major"));
    EXPECT_EQ(read, nullptr);
    std::array<char, 4> few{};
    uint64_t length = 0;
    EXPECT_EQ(haptoflow_clip_write(humming, 7, "", few.data(), few.size(), &length), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_EQ(haptoflow_clip_write(humming, 0, "", few.data(), few.size(), &length), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_THAT(message(), HasSubstr("capacity is 4"));
    EXPECT_EQ(haptoflow_voice_play_clip(opened.voice, humming, std::nanf(""), 0), HAPTOFLOW_INVALID_ARGUMENT);
    auto options = sized<haptoflow_clip_options>();
    options.sample_rate_hz = 3000;
    EXPECT_EQ(haptoflow_clip_create(&options, &read), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_THAT(message(), HasSubstr("sample_rate_hz is 3000"));
    options.sample_rate_hz = 2000;
    EXPECT_EQ(haptoflow_clip_create(&options, &read), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_THAT(message(), HasSubstr("no samples"));
}

TEST_F(ClipApiTest, AClipSoundsWithoutContactAtItsLevelAndEnds) {
    play(humming);
    const std::vector<float> output = hover(1.0);
    const auto middle = output.begin() + 12000;
    EXPECT_NEAR(*std::max_element(middle, middle + 4800), 20.0F / HAPTOFLOW_DEFAULT_FULL_SCALE_MPS2, 0.01F);
    EXPECT_EQ(peak(std::vector<float>(output.begin() + 26000, output.end())), 0.0F);
    const haptoflow_effect_statistics statistics = opened.effect(HAPTOFLOW_EFFECT_CLIP);
    EXPECT_EQ(statistics.events, 1U);
    EXPECT_GT(statistics.samples, 23000U);
}

TEST_F(ClipApiTest, AVoiceThatWasNeverToldOfAContactPlaysOneToo) {
    play(humming);
    EXPECT_GT(peak(opened.render(4800)), 0.05F);
}

TEST_F(ClipApiTest, WithoutAClipNothingOfItRuns) {
    (void)hover(0.2);
    const haptoflow_effect_statistics statistics = opened.effect(HAPTOFLOW_EFFECT_CLIP);
    EXPECT_EQ(statistics.runs + statistics.prepared + statistics.events, 0U);
}

TEST_F(ClipApiTest, TheTextureSoundsOnBesideIt) {
    OpenEngine alone(tinyModelPath);
    for (int update = 0; update < 40; ++update) {
        if (update == 20) {
            play(humming);
        }
        const std::vector<float> both = opened.update(slidingState());
        const std::vector<float> texture = alone.update(slidingState());
        std::vector<float> clip(both.size());
        std::ranges::transform(both, texture, clip.begin(), std::minus<>());
        if (update < 20) {
            EXPECT_EQ(peak(clip), 0.0F);
        } else if (update > 24) {
            EXPECT_NEAR(peak(clip), 0.1F, 0.03F) << update;
        }
    }
}

TEST_F(ClipApiTest, ALoopGoesOnUntilItIsEnded) {
    play(humming, 0.5F, 1);
    (void)hover(2.0);
    // Each round begins with the onset of the wave, a transient.
    EXPECT_NEAR(peak(hover(0.6)), 0.08F, 0.04F);
    play(nullptr);
    (void)hover(0.05);
    EXPECT_EQ(peak(hover(0.2)), 0.0F);
}

TEST_F(ClipApiTest, ReplacedOrEndedInTheMiddleItMakesNoStep) {
    play(humming, 1.0F, 1);
    std::vector<float> output = hover(0.3);
    const ClipHandle other(create(hum(0.2)));
    const std::array<haptoflow_clip*, 3> inTurn{other, other, nullptr};
    for (std::size_t round = 0; round < 20; ++round) {
        play(inTurn[round % 3]);
        const std::vector<float> next = hover(0.03 + 0.001 * static_cast<double>(round));
        output.insert(output.end(), next.begin(), next.end());
    }
    // The wave's own steps are below 0.005; the tail of an ended one begins with 4 % of its value, up to 0.2.
    EXPECT_LT(largestStep(output), 0.016F);
}

TEST_F(ClipApiTest, AClosedClipPlaysToItsEndAndManyInOneBlockLeaveTheLast) {
    for (int i = 0; i < 5; ++i) {
        const ClipHandle each(create(hum(0.3)));
        play(each, 0.1F * static_cast<float>(i + 1));
    }
    const std::vector<float> output = hover(0.25);
    EXPECT_NEAR(peak(std::vector<float>(output.begin() + 4800, output.end())), 0.05F, 0.01F);
}

TEST_F(ClipApiTest, MutePauseAndPanicEndItAndItDoesNotComeBack) {
    const auto endsBy = [this](const char* name, auto&& silence, auto&& release) {
        play(humming, 1.0F, 1);
        EXPECT_GT(peak(hover(0.1)), 0.05F) << name;
        silence();
        (void)hover(0.05);
        EXPECT_EQ(peak(hover(0.1)), 0.0F) << name;
        // Played while silent, it is not played later.
        play(humming);
        (void)hover(0.05);
        release();
        EXPECT_EQ(peak(hover(0.2)), 0.0F) << name;
    };
    endsBy(
        "mute", [this] { EXPECT_EQ(haptoflow_voice_set_muted(opened.voice, 1), HAPTOFLOW_OK); },
        [this] { EXPECT_EQ(haptoflow_voice_set_muted(opened.voice, 0), HAPTOFLOW_OK); });
    endsBy(
        "pause", [this] { EXPECT_EQ(haptoflow_voice_set_paused(opened.voice, 1), HAPTOFLOW_OK); },
        [this] { EXPECT_EQ(haptoflow_voice_set_paused(opened.voice, 0), HAPTOFLOW_OK); });
    play(humming, 1.0F, 1);
    EXPECT_GT(peak(hover(0.1)), 0.05F);
    // Also one that was played before the panic and had not begun.
    play(humming);
    EXPECT_EQ(haptoflow_voice_panic(opened.voice), HAPTOFLOW_OK);
    (void)hover(0.05);
    EXPECT_EQ(peak(hover(0.6)), 0.0F);
    play(humming);
    EXPECT_GT(peak(hover(0.1)), 0.05F) << "after the panic";
}

TEST_F(ClipApiTest, AnotherDeviceRateEndsItAndTheNextSounds) {
    play(humming, 1.0F, 1);
    EXPECT_GT(peak(hover(0.1)), 0.05F);
    for (int block = 0; block < 20; ++block) {
        opened.publish(liftedState());
        (void)opened.render(480, 44100.0);
        opened.step();
    }
    play(humming);
    EXPECT_GT(peak(opened.render(4410, 44100.0)), 0.05F);
}

}  // namespace
}  // namespace haptoflow::capi::testing
