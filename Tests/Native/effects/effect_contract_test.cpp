// What every stage of a voice's chain promises, whichever it is.

#include "effects/clip_sound.hpp"
#include "effects/compensation.hpp"
#include "effects/delay.hpp"
#include "effects/device_loudness.hpp"
#include "effects/exposure_guard.hpp"
#include "effects/impacts.hpp"
#include "effects/signal.hpp"
#include "support/counting_new.hpp"
#include "support/wave_measures.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>
#include <random>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace haptoflow::effects {
namespace {

/// A kind of effect, ready to act on what passes: a source sounds, a delay delays, a guard is near its limits.
struct Kind {
    std::string name;
    std::function<std::unique_ptr<Effect>(double outputRateHz)> make;
};

std::unique_ptr<Effect> ringingImpacts(double outputRateHz) {
    auto impacts = std::make_unique<Impacts>(outputRateHz);
    ImpactResponse response;
    response.modes[0] = {150.0F, 50.0F, 400.0F};
    response.restitution = 0.7F;
    impacts->start(0.5, response);
    return impacts;
}

std::unique_ptr<Effect> soundingSignal(double outputRateHz) {
    auto signal = std::make_unique<Signal>(outputRateHz);
    signal->set({.frequencyHz = 200.0F, .amplitudeMps2 = 6.0F});
    signal->begin();
    return signal;
}

/// A loop of noise with a sample that is no number, begun in the middle of another wave.
std::unique_ptr<Effect> soundingClip(double outputRateHz) {
    static const std::vector<float> wave = [] {
        std::vector<float> samples(977);
        for (std::size_t i = 0; i < samples.size(); ++i) {
            samples[i] = 5.0F * std::sin(0.37F * static_cast<float>(i * i % 1009));
        }
        samples[300] = std::nanf("");
        return samples;
    }();
    auto clip = std::make_unique<ClipSound>(outputRateHz);
    clip->start(wave, 1.0F, false);
    std::vector<float> block(100);
    clip->process(block);
    clip->start(wave, 0.7F, true);
    return clip;
}

std::unique_ptr<Effect> setDelay(double outputRateHz) {
    auto delay = std::make_unique<Delay>(outputRateHz);
    delay->setDelaySeconds(0.01);
    return delay;
}

std::unique_ptr<Effect> quickGuard(double outputRateHz) {
    ExposureLaw law;
    law.shortTermSeconds = 0.5;
    law.slewDbPerSecond = 20.0;
    return std::make_unique<ExposureGuard>(outputRateHz, law);
}

std::unique_ptr<Effect> compensationOfVoiceCoil(double outputRateHz) {
    return std::make_unique<Compensation>(*ActuatorProfile::builtIn("voice-coil"), outputRateHz);
}

constexpr float listenLimitMps2 = 200.0F;

std::unique_ptr<Effect> listen(double outputRateHz) {
    return std::make_unique<Listen>(outputRateHz, listenLimitMps2);
}

std::vector<float> noiseOf(std::size_t count) {
    std::mt19937 random(2);
    std::normal_distribution<float> normal(0.0F, 150.0F);
    std::vector<float> samples(count);
    std::ranges::generate(samples, [&] { return normal(random); });
    return samples;
}

std::vector<float> played(Effect& effect, std::vector<float> samples, std::size_t block) {
    for (std::size_t i = 0; i < samples.size(); i += block) {
        effect.process(std::span(samples).subspan(i, std::min(block, samples.size() - i)));
    }
    return samples;
}

class EffectContractTest : public ::testing::TestWithParam<Kind> {
protected:
    /// True if the effect adds to what passes.
    static bool isSource() {
        return GetParam().name == "Impacts" || GetParam().name == "Signal" || GetParam().name == "ClipSound";
    }
};

INSTANTIATE_TEST_SUITE_P(Of, EffectContractTest,
                         ::testing::Values(Kind{"Impacts", ringingImpacts}, Kind{"Signal", soundingSignal},
                                           Kind{"ClipSound", soundingClip}, Kind{"Delay", setDelay},
                                           Kind{"Compensation", compensationOfVoiceCoil},
                                           Kind{"ExposureGuard", quickGuard}, Kind{"Listen", listen}),
                         [](const auto& kind) { return kind.param.name; });

TEST_P(EffectContractTest, TheBlockLengthsDoNotChangeTheResult) {
    const std::vector<float> sent = noiseOf(44100);
    const std::vector<float> whole = played(*GetParam().make(44100.0), sent, sent.size());
    EXPECT_NE(whole, sent);
    for (const std::size_t block : {7U, 441U, 1024U}) {
        // A signal corrects its radius after each block, and an inaudible sinusoid ends with one.
        const std::vector<float> cut = played(*GetParam().make(44100.0), sent, block);
        for (std::size_t i = 0; i < whole.size(); ++i) {
            ASSERT_NEAR(cut[i], whole[i], isSource() ? 1e-3F : 0.0F) << block << ", sample " << i;
        }
    }
}

TEST_P(EffectContractTest, AnyInputGivesFiniteSamplesAtEveryRateAndNoneAfterAReset) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    for (const double outputRateHz : {8000.0, 44100.0, 48000.0, 192000.0}) {
        const auto effect = GetParam().make(outputRateHz);
        std::vector<float> samples = noiseOf(static_cast<std::size_t>(0.1 * outputRateHz));
        for (std::size_t i = 0; i < samples.size(); i += 7) {
            samples[i] = std::array{std::nanf(""), infinity, -infinity, std::numeric_limits<float>::max()}[i % 4];
        }
        if (isSource()) {
            std::ranges::fill(samples, 2.0F);
        }
        for (const float sample : played(*effect, samples, 33)) {
            ASSERT_TRUE(std::isfinite(sample)) << outputRateHz;
            if (GetParam().name == "Listen") {
                ASSERT_LE(std::abs(sample), listenLimitMps2) << outputRateHz;
            }
        }
        effect->reset();
        std::vector<float> silence(256);
        effect->process(silence);
        EXPECT_EQ(silence, std::vector<float>(256, 0.0F)) << outputRateHz;
    }
}

TEST_P(EffectContractTest, ProcessingAllocatesNothing) {
    const auto effect = GetParam().make(192000.0);
    std::vector<float> samples = noiseOf(1024);
    const std::size_t before = haptoflow::testing::allocationCount();
    for (int block = 0; block < 100; ++block) {
        effect->process(samples);
        (void)effect->isIdle();
    }
    effect->reset();
    EXPECT_EQ(haptoflow::testing::allocationCount(), before);
}

TEST(EffectRatesTest, RatesOutsideTheOutputRangeAreRejected) {
    for (const double outputRateHz : {0.0, 7999.0, 192001.0, -48000.0, std::nan(""), HUGE_VAL}) {
        for (const auto& make : {setDelay, compensationOfVoiceCoil, quickGuard, listen, soundingSignal}) {
            EXPECT_THROW((void)make(outputRateHz), std::invalid_argument) << outputRateHz;
        }
    }
}

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
    std::vector<float> samples = noiseOf(10000);
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
            std::vector<float> samples = haptoflow::testing::sine(63.0, 1.0, 2.0, lineRateHz);
            const std::vector<float> sent = samples;
            delay.setDelaySeconds(before);
            playThrough(delay, samples, 0, second);
            delay.setDelaySeconds(after);
            playThrough(delay, samples, second, second);
            // The steepest step of the sinusoid, plus the crossfade between two taps that differ by at most 2.
            const double sineStep = 2.0 * std::numbers::pi * 63.0 / lineRateHz;
            const double fadeStep = std::numbers::pi / (Delay::fadeSeconds * lineRateHz);
            EXPECT_LE(haptoflow::testing::largestStep(std::span(samples).subspan(second - 2)),
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
    std::vector<float> samples = haptoflow::testing::sine(90.0, 1.0, 2.0, lineRateHz);
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
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const auto& [set, found] : {std::pair{9.0, 0.5}, {nan, 0.5}, {infinity, 0.5}, {-1.0, 0.0}, {-infinity, 0.0}}) {
        delay.setDelaySeconds(set);
        EXPECT_DOUBLE_EQ(delay.delaySeconds(), found) << set;
    }
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
