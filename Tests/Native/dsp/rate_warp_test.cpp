#include "dsp/rate_warp.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

#include "support/wave_measures.hpp"
#include "test_signals.hpp"

namespace haptoflow::dsp {
namespace {

using haptoflow::testing::levelDecibels;
using haptoflow::testing::sinusoid;
using testing::decibels;
using testing::lineSpectrum;
using testing::Uniform;
using testing::whiteNoise;
using testing::wholeHertzNoise;

constexpr double rateHz = 2000.0;

/// Feeds a waveform to a warp block by block, as the callback does.
struct Player {
    RateWarp warp{};
    std::vector<float> waveform;
    std::size_t position = 0;

    std::vector<float> play(std::size_t count) {
        std::vector<float> output(count);
        const std::size_t needed = warp.inputNeeded(count);
        EXPECT_LE(position + needed, waveform.size()) << "the test's waveform is too short";
        warp.process(std::span<const float>(waveform).subspan(position, needed), output);
        position += needed;
        return output;
    }
};

std::size_t settle(Player& player, double ratio) {
    player.warp.setTargetRatio(ratio);
    constexpr std::size_t count = 1000;
    (void)player.play(count);
    EXPECT_DOUBLE_EQ(player.warp.ratio(), ratio);
    return count;
}

TEST(RateWarpTest, AtRatioOneTheOutputEqualsTheInputWithoutDelay) {
    Player player{.waveform = whiteNoise(1000, 10.0, 71)};
    const std::vector<float> output = player.play(900);
    EXPECT_TRUE(player.warp.isTransparent());
    for (std::size_t i = 0; i < output.size(); ++i) {
        ASSERT_EQ(output[i], player.waveform[i]);
    }
    EXPECT_EQ(player.position, output.size()) << "no sample is read ahead";
}

TEST(RateWarpTest, APrimedWarpContinuesAsIfItHadPlayedThePast) {
    const std::vector<float> waveform = whiteNoise(2000, 1.0, 81);
    Player played{.waveform = waveform};
    (void)played.play(200);
    Player primed{.waveform = waveform};
    primed.warp.prime(std::span(waveform).subspan(200 - RateWarp::historyLength, RateWarp::historyLength));
    primed.position = 200;
    for (const double ratio : {1.0, 3.0, 1.0}) {
        played.warp.setTargetRatio(ratio);
        primed.warp.setTargetRatio(ratio);
        ASSERT_EQ(primed.play(150), played.play(150)) << "ratio " << ratio;
    }
}

TEST(RateWarpTest, ATonesFrequencyIsMultipliedByTheRatioAndItsAmplitudeIsKept) {
    // Output frequencies are whole hertz, so that one second holds whole periods.
    for (const double ratio : {1.2, 1.5, 2.0, 2.5, 3.3, 4.0}) {
        for (const std::size_t outputHz : {30U, 200U, 400U, 600U}) {
            const double inputHz = static_cast<double>(outputHz) / ratio;
            Player player{.waveform = sinusoid(20000, inputHz)};
            settle(player, ratio);
            const auto lines = lineSpectrum(player.play(2000), 0, 2000);
            EXPECT_NEAR(decibels(std::abs(lines[outputHz])), 0.0, 0.1) << inputHz << " Hz at ratio " << ratio;
            for (std::size_t k = 0; k < lines.size(); ++k) {
                if (k != outputHz) {
                    ASSERT_LT(decibels(std::abs(lines[k])), -60.0) << "stray line at " << k << " Hz, ratio " << ratio;
                }
            }
        }
    }
}

TEST(RateWarpTest, FrequenciesThatWouldAliasAreRemoved) {
    for (const double ratio : {1.2, 1.7, 2.5, 4.0}) {
        const double lowestHz = std::ceil(1000.0 / ratio);
        Player player{.waveform = wholeHertzNoise(10, static_cast<int>(lowestHz) + 1, 999, 2000, 74)};
        settle(player, ratio);
        const std::vector<float> output = player.play(2000);
        const double inputDb = levelDecibels(std::span(player.waveform).first(2000));
        EXPECT_LT(levelDecibels(output) - inputDb, -60.0) << "ratio " << ratio;
    }
}

TEST(RateWarpTest, EveryOutputIsTheWaveformAtASmoothlyMovingReadPosition) {
    constexpr double frequency = 100.0;
    Player player{.waveform = sinusoid(40000, frequency)};
    (void)player.play(50);
    double position = player.warp.readPosition();
    double step = 1.0;
    for (const double ratio : {4.0, 1.0, 1.001, 1.0, 2.2, 1.0}) {
        player.warp.setTargetRatio(ratio);
        for (int i = 0; i < 400; ++i) {
            const float output = player.play(1).front();
            const double expected = std::sin(2.0 * std::numbers::pi * frequency * position / rateHz);
            ASSERT_NEAR(output, expected, 0.01) << "output " << i << " on the way to ratio " << ratio;
            const double next = player.warp.readPosition();
            ASSERT_GE(next - position, 1.0 - 1e-9);
            ASSERT_LE(next - position, 4.0 + 1e-9);
            // With a time constant of 10 ms, the ratio moves per sample by 5 % of the largest distance, 3.
            ASSERT_LE(std::abs(next - position - step), 0.151) << "output " << i << " on the way to ratio " << ratio;
            step = next - position;
            position = next;
        }
        EXPECT_NEAR(step, ratio, 1e-6);
    }
    EXPECT_TRUE(player.warp.isTransparent());
    EXPECT_DOUBLE_EQ(position, static_cast<double>(player.position)) << "the delay is 0 again";
}

TEST(RateWarpTest, TheBlockLengthsDoNotChangeTheOutput) {
    Player whole{.waveform = whiteNoise(10000, 1.0, 76)};
    Player blocks{.waveform = whole.waveform};
    for (const double ratio : {1.0, 3.7, 1.3, 1.0}) {
        whole.warp.setTargetRatio(ratio);
        blocks.warp.setTargetRatio(ratio);
        const std::vector<float> expected = whole.play(330);
        std::vector<float> output;
        while (output.size() < expected.size()) {
            const std::vector<float> samples = blocks.play(std::min<std::size_t>(7, expected.size() - output.size()));
            output.insert(output.end(), samples.begin(), samples.end());
        }
        ASSERT_EQ(output, expected);
        ASSERT_EQ(whole.position, blocks.position);
    }
}

TEST(RateWarpTest, TheWarpConsumesAtTheRatioAndReadsTenTimesTheRatioBehind) {
    Player player{.waveform = whiteNoise(20000, 1.0, 77)};
    settle(player, 2.5);
    const std::size_t before = player.position;
    (void)player.play(400);
    EXPECT_EQ(player.position - before, 1000U);
    // Between two outputs the read position already belongs to the next output, up to r samples ahead.
    EXPECT_NEAR(static_cast<double>(player.position) - player.warp.readPosition(), 25.0 - 1.25, 2.0);
    EXPECT_NEAR(player.warp.samplesAhead(), static_cast<double>(player.position) - player.warp.readPosition(), 1e-9);
}

TEST(RateWarpTest, RatiosOutsideOneToFourAreClampedAndNonFiniteOnesIgnored) {
    Player player{.waveform = whiteNoise(20000, 1.0, 78)};
    player.warp.setTargetRatio(100.0);
    (void)player.play(1000);
    EXPECT_DOUBLE_EQ(player.warp.ratio(), RateWarp::maximumRatio);
    player.warp.setTargetRatio(std::numeric_limits<double>::quiet_NaN());
    player.warp.setTargetRatio(std::numeric_limits<double>::infinity());
    (void)player.play(100);
    EXPECT_DOUBLE_EQ(player.warp.ratio(), RateWarp::maximumRatio);
    player.warp.setTargetRatio(-3.0);
    (void)player.play(400);
    EXPECT_TRUE(player.warp.isTransparent());
}

TEST(RateWarpTest, ABlockNeverConsumesMoreThanFourTimesItsLengthPlusFortyOne) {
    Player player{.waveform = whiteNoise(400000, 1.0, 79)};
    Uniform uniform(80);
    for (int i = 0; i < 500; ++i) {
        player.warp.setTargetRatio(uniform(0.5, 4.5));
        const std::size_t count = uniform.whole(1, 100);
        ASSERT_LE(player.warp.inputNeeded(count), 4 * count + 41);
        for (const float sample : player.play(count)) {
            ASSERT_TRUE(std::isfinite(sample));
            ASSERT_LT(std::abs(sample), 4.0F);
        }
    }
}

}  // namespace
}  // namespace haptoflow::dsp
