#include "effects/delay.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

namespace haptoflow::effects {
namespace {

constexpr double everyRateHz[] = {8000.0, 11025.0, 24000.0, 44100.0, 48000.0, 96000.0, 192000.0};

void playThrough(Delay& delay, std::vector<float>& samples, std::size_t from, std::size_t count,
                 std::size_t block = 256) {
    for (std::size_t i = from; i < from + count; i += block) {
        delay.process(std::span(samples).subspan(i, std::min(block, from + count - i)));
    }
}

void playThrough(Delay& delay, std::vector<float>& samples) {
    playThrough(delay, samples, 0, samples.size());
}

std::vector<float> sineWave(double frequencyHz, double lineRateHz, std::size_t count, double amplitudeMps2 = 1.0) {
    std::vector<float> out(count);
    for (std::size_t i = 0; i < count; ++i) {
        out[i] = static_cast<float>(
            amplitudeMps2 * std::sin(2.0 * std::numbers::pi * frequencyHz * static_cast<double>(i) / lineRateHz));
    }
    return out;
}

double largestStep(const std::vector<float>& samples) {
    double largest = 0.0;
    for (std::size_t i = 1; i < samples.size(); ++i) {
        largest = std::max(largest, static_cast<double>(std::abs(samples[i] - samples[i - 1])));
    }
    return largest;
}

TEST(DelayTest, AnImpulseIsDelayedByTheRoundedNumberOfSamplesAtEveryRate) {
    for (const double lineRateHz : everyRateHz) {
        for (const double seconds : {0.0, 1.4 / lineRateHz, 1.6 / lineRateHz, 0.0103, 0.1303, 0.5}) {
            Delay delay(lineRateHz);
            delay.setDelaySeconds(seconds);
            const auto later = static_cast<std::size_t>(std::llround(seconds * lineRateHz));
            std::vector<float> samples(later + 500, 0.0F);
            samples[100] = 7.0F;
            playThrough(delay, samples);
            for (std::size_t i = 0; i < samples.size(); ++i) {
                ASSERT_EQ(samples[i], i == 100 + later ? 7.0F : 0.0F)
                    << lineRateHz << " Hz, " << seconds << " s, " << i;
            }
        }
    }
}

TEST(DelayTest, ADelayOfZeroLeavesTheSignalUnchanged) {
    Delay delay(48000.0);
    std::mt19937 random(3);
    std::normal_distribution<float> noise(0.0F, 30.0F);
    std::vector<float> samples(10000);
    std::ranges::generate(samples, [&] { return noise(random); });
    samples[17] = std::numeric_limits<float>::denorm_min();
    samples[18] = -0.0F;
    const std::vector<float> sent = samples;
    for (std::size_t i = 0; i < samples.size(); i += 100) {
        delay.setDelaySeconds(0.0);
        delay.process(std::span(samples).subspan(i, 100));
    }
    EXPECT_EQ(samples, sent);
    EXPECT_TRUE(std::signbit(samples[18]));
}

TEST(DelayTest, AChangeWhileSoundingCrossfadesWithoutAClickAndIsThenExact) {
    for (const double lineRateHz : everyRateHz) {
        for (const auto& [before, after] : {std::pair{0.0, 0.2}, {0.2, 0.0}, {0.5, 0.01}, {0.05, 0.051}}) {
            Delay delay(lineRateHz);
            const auto second = static_cast<std::size_t>(lineRateHz);
            std::vector<float> samples = sineWave(63.0, lineRateHz, 2 * second);
            const std::vector<float> sent = samples;
            delay.setDelaySeconds(before);
            playThrough(delay, samples, 0, second);
            delay.setDelaySeconds(after);
            playThrough(delay, samples, second, second);
            // The steepest step of the sinusoid, plus the crossfade between two taps that differ by at most 2.
            const double sineStep = 2.0 * std::numbers::pi * 63.0 / lineRateHz;
            const double fadeStep = std::numbers::pi / (Delay::fadeSeconds * lineRateHz);
            EXPECT_LE(largestStep(
                          std::vector<float>(samples.begin() + static_cast<std::ptrdiff_t>(second) - 2, samples.end())),
                      1.01 * (sineStep + fadeStep))
                << lineRateHz << " Hz, from " << before << " to " << after;
            const auto later = static_cast<std::size_t>(std::llround(after * lineRateHz));
            const auto faded = second + static_cast<std::size_t>(Delay::fadeSeconds * lineRateHz) + 2;
            for (std::size_t i = faded; i < samples.size(); ++i) {
                ASSERT_EQ(samples[i], sent[i - later]) << lineRateHz << " Hz, sample " << i;
            }
        }
    }
}

TEST(DelayTest, ChangesDuringAFadeWaitForItsEndAndOnlyTheNewestCounts) {
    constexpr double lineRateHz = 10000.0;
    Delay waiting(lineRateHz);
    Delay reference(lineRateHz);
    std::vector<float> samples = sineWave(90.0, lineRateHz, 20000);
    std::vector<float> expected = samples;
    const auto fade = static_cast<std::size_t>(std::lround(Delay::fadeSeconds * lineRateHz));
    playThrough(waiting, samples, 0, 10000);
    playThrough(reference, expected, 0, 10000);
    waiting.setDelaySeconds(0.1);
    reference.setDelaySeconds(0.1);
    playThrough(waiting, samples, 10000, 50);
    waiting.setDelaySeconds(0.4);
    playThrough(waiting, samples, 10050, 50);
    waiting.setDelaySeconds(0.02);
    playThrough(waiting, samples, 10100, 9900);
    // The expected output is that of a change requested at the end of the fade.
    playThrough(reference, expected, 10000, fade);
    reference.setDelaySeconds(0.02);
    playThrough(reference, expected, 10000 + fade, 10000 - fade);
    EXPECT_EQ(samples, expected);
}

TEST(DelayTest, DelaysOutOfRangeAreClampedAndNaNIsIgnored) {
    Delay delay(8000.0);
    delay.setDelaySeconds(9.0);
    EXPECT_DOUBLE_EQ(delay.delaySeconds(), 0.5);
    delay.setDelaySeconds(std::numeric_limits<double>::quiet_NaN());
    EXPECT_DOUBLE_EQ(delay.delaySeconds(), 0.5);
    delay.setDelaySeconds(std::numeric_limits<double>::infinity());
    EXPECT_DOUBLE_EQ(delay.delaySeconds(), 0.5);
    delay.setDelaySeconds(-1.0);
    EXPECT_DOUBLE_EQ(delay.delaySeconds(), 0.0);
    delay.setDelaySeconds(-std::numeric_limits<double>::infinity());
    EXPECT_DOUBLE_EQ(delay.delaySeconds(), 0.0);
}

TEST(DelayTest, IsIdleOnlyOnceTheLineHoldsNothingButSilence) {
    constexpr double lineRateHz = 8000.0;
    Delay delay(lineRateHz);
    EXPECT_TRUE(delay.isIdle());
    std::vector<float> samples(8000, 0.0F);
    samples[0] = 1.0F;
    playThrough(delay, samples, 0, 1);
    EXPECT_FALSE(delay.isIdle()) << "with a longer delay the impulse would still sound";
    playThrough(delay, samples, 1, 4000);
    EXPECT_FALSE(delay.isIdle()) << "with the maximum delay the impulse is the next sample";
    playThrough(delay, samples, 4001, 1);
    EXPECT_TRUE(delay.isIdle());
}

TEST(DelayTest, AResetClearsTheSignalAndKeepsTheDelay) {
    Delay delay(8000.0);
    delay.setDelaySeconds(0.1);
    std::vector<float> samples(4000, 5.0F);
    playThrough(delay, samples);
    delay.setDelaySeconds(0.2);
    playThrough(delay, samples, 3000, 40);
    delay.reset();
    EXPECT_TRUE(delay.isIdle());
    std::vector<float> after(4000, 0.0F);
    after[0] = 1.0F;
    playThrough(delay, after);
    for (std::size_t i = 0; i < after.size(); ++i) {
        ASSERT_EQ(after[i], i == 1600 ? 1.0F : 0.0F) << i;
    }
}

}  // namespace
}  // namespace haptoflow::effects
