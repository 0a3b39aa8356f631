#include "effects/signal.hpp"

#include "support/counting_new.hpp"
#include "support/wave_measures.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <stdexcept>
#include <vector>

namespace haptoflow::effects {
namespace {

class SignalTest : public ::testing::Test {
protected:
    static constexpr double rateHz = 48000.0;
    static constexpr std::size_t rampSamples = 96;

    static std::vector<float> play(Signal& signal, std::size_t count, std::size_t block = 64) {
        std::vector<float> samples(count, 0.0F);
        for (std::size_t i = 0; i < count; i += block) {
            signal.process(std::span(samples).subspan(i, std::min(block, count - i)));
        }
        return samples;
    }

    static double sineAt(double frequencyHz, std::size_t sample, double atRateHz = rateHz) {
        return std::sin(2.0 * std::numbers::pi * frequencyHz * static_cast<double>(sample) / atRateHz);
    }
};

TEST_F(SignalTest, TheSignalIsTheRequestedSinusoidAfterA2MsRampAtEveryRate) {
    for (const double rate : {8000.0, 44100.0, 48000.0, 96000.0, 192000.0}) {
        Signal signal(rate);
        signal.set({.frequencyHz = 200.0F, .amplitudeMps2 = 6.0F});
        signal.begin();
        const std::vector<float> samples = play(signal, static_cast<std::size_t>(rate), 57);
        const auto ramp = static_cast<std::size_t>(0.002 * rate + 1e-6);
        for (std::size_t i = 0; i < samples.size(); ++i) {
            const double progress = std::min(1.0, static_cast<double>(i + 1) / static_cast<double>(ramp));
            const double gain = 0.5 - 0.5 * std::cos(std::numbers::pi * progress);
            ASSERT_NEAR(samples[i], 6.0 * gain * sineAt(200.0, i, rate), 2e-5) << rate << " Hz, sample " << i;
        }
    }
}

TEST_F(SignalTest, TheSignalEndsWithin2MsWithoutAStepAndIsThenIdle) {
    Signal signal(rateHz);
    signal.set({.frequencyHz = 200.0F, .amplitudeMps2 = 1.0F});
    EXPECT_TRUE(signal.isIdle());
    signal.begin();
    std::vector<float> samples = play(signal, 1061, 61);
    signal.end();
    const std::vector<float> ending = play(signal, rampSamples, 32);
    EXPECT_TRUE(signal.isIdle());
    samples.insert(samples.end(), ending.begin(), ending.end());
    const std::vector<float> after = play(signal, 500);
    EXPECT_TRUE(std::ranges::all_of(after, [](float sample) { return sample == 0.0F; }));
    samples.insert(samples.end(), after.begin(), after.end());
    const double steepest = 2.0 * std::numbers::pi * (200.0 + 0.25 / 0.002) / rateHz;
    EXPECT_LT(static_cast<double>(testing::largestStep(samples)), steepest);
}

TEST_F(SignalTest, ASignalThatRestartsWhileItEndsContinuesInPhase) {
    Signal signal(rateHz);
    signal.set({.frequencyHz = 100.0F, .amplitudeMps2 = 1.0F});
    signal.begin();
    (void)play(signal, 1000);
    signal.end();
    (void)play(signal, rampSamples / 2);
    EXPECT_FALSE(signal.isIdle());
    EXPECT_FALSE(signal.isOn());
    signal.begin();
    const std::vector<float> samples = play(signal, 2000);
    for (std::size_t i = rampSamples; i < samples.size(); ++i) {
        ASSERT_NEAR(samples[i], sineAt(100.0, 1000 + rampSamples / 2 + i), 1e-5) << i;
    }
}

TEST_F(SignalTest, ChangesOfFrequencyAndAmplitudeMakeNoStep) {
    Signal signal(rateHz);
    std::vector<float> samples;
    signal.begin();
    for (int change = 0; change < 40; ++change) {
        signal.set({.frequencyHz = change % 2 == 0 ? 500.0F : 20.0F, .amplitudeMps2 = change % 3 == 0 ? 1.0F : 0.1F});
        const std::vector<float> part = play(signal, 700, 50);
        samples.insert(samples.end(), part.begin(), part.end());
    }
    const double steepest = 2.0 * std::numbers::pi * (500.0 + 0.25 / 0.002) / rateHz + 1.0 / 480.0;
    EXPECT_LT(static_cast<double>(testing::largestStep(samples)), steepest);
    EXPECT_NEAR(testing::peak(samples), 1.0F, 0.05F);
}

TEST_F(SignalTest, UnsetSettingsDoNotChangeASoundingSignal) {
    Signal signal(rateHz);
    Signal same(rateHz);
    for (Signal* each : {&signal, &same}) {
        each->set({.frequencyHz = 200.0F, .amplitudeMps2 = 1.0F});
        each->begin();
        (void)play(*each, 300);
    }
    signal.set({});
    EXPECT_EQ(play(signal, 300), play(same, 300));
}

TEST_F(SignalTest, TheAudioThreadFunctionsAllocateNothing) {
    Signal signal(rateHz);
    std::array<float, 64> block{};
    const std::size_t before = haptoflow::testing::allocationCount();
    for (int i = 0; i < 100; ++i) {
        signal.set({.frequencyHz = 20.0F + static_cast<float>(i), .amplitudeMps2 = 1.0F});
        if (i % 7 == 3) {
            signal.end();
        } else {
            signal.begin();
        }
        signal.process(block);
    }
    signal.reset();
    EXPECT_EQ(haptoflow::testing::allocationCount(), before);
}

}  // namespace
}  // namespace haptoflow::effects
