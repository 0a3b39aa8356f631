#include "effects/impacts.hpp"

#include "effects/signal.hpp"
#include "support/wave_measures.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

namespace haptoflow::effects {
namespace {

constexpr double rateHz = 48000.0;

ImpactResponse ringing(float frequencyHz, float decayPerSecond, float gainPerSecond) {
    ImpactResponse response;
    response.modes[0] = {frequencyHz, decayPerSecond, gainPerSecond};
    return response;
}

std::vector<float> next(Impacts& impacts, std::size_t count, std::size_t block = 256) {
    std::vector<float> out(count);
    for (std::size_t i = 0; i < count; i += block) {
        impacts.process(std::span(out).subspan(i, std::min(block, count - i)));
    }
    return out;
}

using haptoflow::testing::peak;

TEST(ImpactsTest, ABlowIsADecayingSinusoidThatStartsWithTheNextSample) {
    for (const double rate : {8000.0, 44100.0, 48000.0, 192000.0}) {
        Impacts impacts(rate);
        impacts.start(0.2, ringing(180.0F, 90.0F, 600.0F));
        const std::vector<float> output = next(impacts, static_cast<std::size_t>(0.1 * rate), 61);
        for (std::size_t i = 0; i < output.size(); ++i) {
            const double seconds = static_cast<double>(i) / rate;
            const double expected =
                120.0 * std::exp(-90.0 * seconds) * std::sin(2.0 * std::numbers::pi * 180.0 * seconds);
            ASSERT_NEAR(static_cast<double>(output[i]), expected, 1e-3) << "rate " << rate << ", sample " << i;
        }
    }
}

TEST(ImpactsTest, TheAmplitudeIsProportionalToTheSpeedFromOneCentimetreToTwoMetresASecond) {
    const auto peakAt = [](double speedMps) {
        Impacts impacts(rateHz);
        impacts.start(speedMps, ringing(200.0F, 60.0F, 500.0F));
        return static_cast<double>(peak(next(impacts, 4800)));
    };
    const double atOne = peakAt(1.0);
    for (const double speedMps : {0.01, 0.03, 0.1, 0.3, 0.7, 2.0}) {
        EXPECT_NEAR(peakAt(speedMps) / (speedMps * atOne), 1.0, 1e-4) << speedMps;
    }
    EXPECT_DOUBLE_EQ(peakAt(7.0), peakAt(Impacts::maximumEventMps));
}

TEST(ImpactsTest, ReboundsFollowTheirFlightTimesAndGetWeaker) {
    ImpactResponse response = ringing(400.0F, 2000.0F, 500.0F);
    response.restitution = 0.5F;
    Impacts impacts(rateHz);
    impacts.start(0.5, response);
    const std::vector<float> output = next(impacts, 9600, 100);
    // A flight takes 2 v / (25 m/s^2): 20 ms at the remaining 0.25 m/s, then 10 ms.
    const auto peakFrom = [&](double fromSeconds, double untilSeconds) {
        const auto from = static_cast<std::size_t>(fromSeconds * rateHz);
        const auto until = static_cast<std::size_t>(untilSeconds * rateHz);
        return static_cast<double>(peak(std::span(output).subspan(from, until - from)));
    };
    const double first = peakFrom(0.0, 0.01);
    EXPECT_LT(peakFrom(0.015, 0.0199), 0.01 * first);
    EXPECT_NEAR(peakFrom(0.0199, 0.0299) / first, 0.5, 0.01);
    EXPECT_NEAR(peakFrom(0.0301, 0.04) / first, 0.25, 0.01);
    EXPECT_LT(peakFrom(0.05, 0.096), 0.01 * first) << "after two rebounds there is no third";
    EXPECT_TRUE(impacts.isIdle());
}

TEST(ImpactsTest, TheSourceIsIdleAfterABlowHasDecayed) {
    Impacts impacts(rateHz);
    EXPECT_TRUE(impacts.isIdle());
    impacts.start(2.0, ringing(100.0F, 40.0F, 1000.0F));
    EXPECT_FALSE(impacts.isIdle());
    const double decaySeconds = std::log(2000.0 / imperceptibleMps2) / 40.0;
    next(impacts, static_cast<std::size_t>((decaySeconds + 0.01) * rateHz));
    EXPECT_TRUE(impacts.isIdle());
    EXPECT_EQ(next(impacts, 256), std::vector<float>(256, 0.0F));
}

TEST(ImpactsTest, ManyBlowsAtOnceAreBoundedAndTheLoudestAreKept) {
    Impacts impacts(rateHz);
    impacts.start(1.0, ringing(150.0F, 50.0F, 400.0F));
    for (int event = 0; event < 200; ++event) {
        impacts.start(0.001, ringing(300.0F, 50.0F, 400.0F));
    }
    const float largest = peak(next(impacts, 4800));
    EXPECT_GT(largest, 300.0F) << "the loud event was replaced";
    EXPECT_LT(largest, 400.0F * 1.1F);
}

TEST(ImpactsTest, InvalidBlowsMakeNoSound) {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    constexpr float infinity = std::numeric_limits<float>::infinity();
    Impacts impacts(rateHz);
    for (const double speedMps : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
        impacts.start(speedMps, ringing(150.0F, 50.0F, 400.0F));
    }
    for (const ImpactResponse& response :
         {ImpactResponse{}, ringing(nan, 50.0F, 400.0F), ringing(150.0F, nan, nan), ringing(-3.0F, 50.0F, 400.0F),
          ringing(infinity, 50.0F, 400.0F), ringing(40000.0F, 50.0F, 400.0F), ringing(150.0F, infinity, 400.0F)}) {
        impacts.start(0.5, response);
    }
    EXPECT_EQ(next(impacts, 512), std::vector<float>(512, 0.0F));
    impacts.start(std::numeric_limits<double>::infinity(), ringing(150.0F, 50.0F, infinity));
    for (const float sample : next(impacts, 4800)) {
        ASSERT_TRUE(std::isfinite(sample));
    }
}

TEST(ImpactsTest, ASourceAddsToTheInput) {
    Impacts alone(rateHz, 3.0);
    Impacts added(rateHz, 3.0);
    alone.start(0.3, ringing(220.0F, 80.0F, 300.0F));
    added.start(0.3, ringing(220.0F, 80.0F, 300.0F));
    std::vector<float> out(480, 2.0F);
    added.process(out);
    const std::vector<float> event = next(alone, 480);
    for (std::size_t i = 0; i < out.size(); ++i) {
        ASSERT_FLOAT_EQ(out[i], 2.0F + event[i]);
    }
}

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
    EXPECT_LT(static_cast<double>(haptoflow::testing::largestStep(samples)), steepest);
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
    EXPECT_LT(static_cast<double>(haptoflow::testing::largestStep(samples)), steepest);
    EXPECT_NEAR(peak(samples), 1.0F, 0.05F);
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

}  // namespace
}  // namespace haptoflow::effects
