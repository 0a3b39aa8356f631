#include "engine/voice.hpp"

#include "simulated_device.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace haptoflow::engine {
namespace {

EffectFigures unreadFigures;
constexpr double playedRateHz = 48000.0;

/// A seed of 120 Hz at a level, with phase zero at its middle, where it starts to sound.
std::array<float, 400> toneSeed(float levelMps2) {
    std::array<float, 400> seed{};
    for (std::size_t i = 0; i < seed.size(); ++i) {
        const double t = (static_cast<double>(i) - 200.0) / 2000.0;
        seed[i] = levelMps2 * static_cast<float>(std::numbers::sqrt2 * std::sin(2.0 * std::numbers::pi * 120.0 * t));
    }
    return seed;
}

std::vector<float> renderSamples(Voice& voice, std::size_t count) {
    std::vector<float> samples(count);
    voice.render(samples);
    return samples;
}

TEST(VoiceTest, WithoutTouchTheVoiceWritesZerosAndItsClockStandsStill) {
    Voice voice(playedRateHz, 60.0F, unreadFigures);
    const std::int64_t head = voice.timeline().head();
    const std::vector<float> output = renderSamples(voice, 4800);
    EXPECT_TRUE(std::ranges::all_of(output, [](float sample) { return sample == 0.0F; }));
    EXPECT_EQ(voice.timeline().head(), head);
    EXPECT_TRUE(voice.isSilent());
}

TEST(VoiceTest, TheSeedSoundsAtOnceWithAConstantDelay) {
    Voice voice(playedRateHz, 60.0F, unreadFigures);
    voice.onset(toneSeed(6.0F), 1.0F);
    const std::vector<float> output = renderSamples(voice, 1440);
    // After the ramp of 2 ms, the output is the seed with a delay below a millisecond.
    double best = 0.0;
    std::size_t bestDelay = 0;
    for (std::size_t delay = 0; delay < 240; ++delay) {
        double product = 0.0;
        for (std::size_t i = 300; i < 1200; ++i) {
            const double t = (static_cast<double>(i) - static_cast<double>(delay)) / playedRateHz;
            product += static_cast<double>(output[i]) * std::sin(2.0 * std::numbers::pi * 120.0 * t);
        }
        if (product > best) {
            best = product;
            bestDelay = delay;
        }
    }
    EXPECT_LE(bestDelay, 48U) << "the delay in samples at 48 kHz";
    double squares = 0.0;
    for (std::size_t i = 400; i < 1200; ++i) {
        squares += static_cast<double>(output[i]) * static_cast<double>(output[i]);
    }
    EXPECT_NEAR(std::sqrt(squares / 800.0), 0.1, 0.003);
}

TEST(VoiceTest, ATouchDuringAFadeStartsWithoutAStep) {
    Voice voice(playedRateHz, 60.0F, unreadFigures);
    voice.onset(toneSeed(6.0F), 1.0F);
    std::vector<float> output = renderSamples(voice, 1777);
    const float ordinaryStep = testing::largestStep(output);
    for (int touch = 0; touch < 6; ++touch) {
        voice.release();
        const std::vector<float> fading = renderSamples(voice, 101);
        output.insert(output.end(), fading.begin(), fading.end());
        voice.onset(toneSeed(6.0F), 1.0F);
        const std::vector<float> sounding = renderSamples(voice, 733);
        output.insert(output.end(), sounding.begin(), sounding.end());
    }
    // A seam in the waveform is a splice of 4 samples at 2 kHz, which is steeper than the tone but not a step.
    EXPECT_LE(testing::largestStep(output), 6.0F * ordinaryStep);
}

TEST(VoiceTest, TheOutputDoesNotDependOnTheBlockLength) {
    Voice whole(playedRateHz, 60.0F, unreadFigures);
    Voice pieces(playedRateHz, 60.0F, unreadFigures);
    whole.onset(toneSeed(3.0F), 1.0F);
    pieces.onset(toneSeed(3.0F), 1.0F);
    const std::vector<float> expected = renderSamples(whole, 4096);
    std::vector<float> output;
    for (const std::size_t count : {1U, 63U, 64U, 65U, 256U, 700U, 1000U, 1947U}) {
        const std::vector<float> block = renderSamples(pieces, count);
        output.insert(output.end(), block.begin(), block.end());
    }
    ASSERT_EQ(output.size(), expected.size());
    EXPECT_TRUE(std::equal(output.begin(), output.end(), expected.begin()));
}

TEST(VoiceTest, ANonFiniteSeedGivesSilenceAndIsCounted) {
    Voice voice(playedRateHz, 60.0F, unreadFigures);
    std::array<float, 400> seed = toneSeed(6.0F);
    seed[300] = std::nanf("");
    voice.onset(seed, 1.0F);
    const std::vector<float> output = renderSamples(voice, 9600);
    EXPECT_TRUE(std::ranges::all_of(output, [](float sample) { return std::isfinite(sample); }));
    EXPECT_GT(voice.limiter().nonFiniteCount(), 0U);
    voice.release();
    (void)renderSamples(voice, 480);
    voice.onset(toneSeed(6.0F), 1.0F);
    EXPECT_GT(testing::peak(renderSamples(voice, 960)), 0.1F) << "the next touch must sound normally";
}

TEST(VoiceTest, InsideTheRangeTheFiltersDelayByAtMostOneAndAHalfMilliseconds) {
    // A step in the waveform at a known sample. The delay is the time until half of the step has been output.
    Voice voice(playedRateHz, 60.0F, unreadFigures);
    voice.onset(std::array<float, 400>{}, 1.0F);
    std::vector<float> output = renderSamples(voice, 480);
    const std::int64_t step = voice.timeline().head() + 10;
    std::array<float, 200> segment{};
    std::fill(segment.begin() + 10, segment.end(), 6.0F);
    ASSERT_EQ(voice.commit(step - 10, segment, 1.0F), step - 10);
    const double readAt = 480.0 / playedRateHz + 10.0 / 2000.0;
    const std::vector<float> later = renderSamples(voice, 2400);
    output.insert(output.end(), later.begin(), later.end());
    const auto half = std::ranges::find_if(output, [](float sample) { return sample >= 0.05F; });
    const double seconds = static_cast<double>(half - output.begin()) / playedRateHz;
    EXPECT_GE(seconds, readAt - 0.0005) << "the step cannot be output before it was read";
    EXPECT_LE(seconds - readAt, 0.0015);
}

}  // namespace
}  // namespace haptoflow::engine
