#include "dsp/gate.hpp"

#include "dsp/splice.hpp"
#include "test_signals.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <stdexcept>
#include <vector>

namespace haptoflow::dsp {
namespace {

using testing::Uniform;
using testing::whiteNoise;

constexpr double everyRate[] = {2000.0, 8000.0, 11025.0, 44100.0, 48000.0, 192000.0};

std::size_t samplesIn(double seconds, double rate) {
    return static_cast<std::size_t>(seconds * rate + 1e-6);
}

TEST(GateTest, OpensWithinTwoMillisecondsAndClosesWithinFiveAtAnyRate) {
    for (const double rate : everyRate) {
        Gate gate(rate);
        gate.open();
        for (std::size_t i = 0; i + 1 < samplesIn(0.002, rate); ++i) {
            ASSERT_LT(gate.nextGain(), 1.0F) << rate;
        }
        ASSERT_EQ(gate.nextGain(), 1.0F) << rate;
        gate.close();
        for (std::size_t i = 0; i + 1 < samplesIn(0.005, rate); ++i) {
            ASSERT_GT(gate.nextGain(), 0.0F) << rate;
            ASSERT_FALSE(gate.isClosed());
        }
        ASSERT_EQ(gate.nextGain(), 0.0F) << rate;
        ASSERT_TRUE(gate.isClosed());
    }
}

TEST(GateTest, AChangeOfDirectionAtAnySampleMakesNoStepLargerThanTheSteepestRamp) {
    for (const double rate : everyRate) {
        Gate gate(rate);
        Uniform uniform(31);
        // The steepest slope of the opening ramp is pi / 2 over 2 ms.
        const double largest = std::numbers::pi / 2.0 / static_cast<double>(samplesIn(0.002, rate)) + 1e-6;
        double previous = 0.0;
        bool sawOpen = false;
        bool sawClosed = false;
        for (int i = 0; i < 200000; ++i) {
            if (i < 100000 || uniform(0.0, 1.0) < 0.003) {
                uniform(0.0, 1.0) < 0.5 ? gate.open() : gate.close();
            }
            const double gain = gate.nextGain();
            ASSERT_LE(std::abs(gain - previous), largest) << "sample " << i << " at " << rate << " Hz";
            ASSERT_GE(gain, 0.0);
            ASSERT_LE(gain, 1.0);
            sawOpen = sawOpen || gain == 1.0;
            sawClosed = sawClosed || (i > 0 && gain == 0.0);
            previous = gain;
        }
        EXPECT_TRUE(sawOpen && sawClosed) << "the walk never reached both ends at " << rate << " Hz";
    }
}

TEST(GateTest, TheGateIsClosedFiveMillisecondsAfterCloseFromAnyPosition) {
    for (const double rate : everyRate) {
        Uniform uniform(32);
        for (int round = 0; round < 200; ++round) {
            Gate gate(rate);
            gate.open();
            const std::size_t opened = uniform.whole(0, 2 * samplesIn(0.002, rate));
            for (std::size_t i = 0; i < opened; ++i) {
                (void)gate.nextGain();
            }
            gate.close();
            for (std::size_t i = 0; i < samplesIn(0.005, rate); ++i) {
                (void)gate.nextGain();
            }
            ASSERT_TRUE(gate.isClosed());
        }
    }
}

TEST(GateTest, AClosedGateOutputsExactZerosEvenForNaN) {
    Gate gate(48000.0);
    std::vector<float> samples = whiteNoise(100, 10.0, 33);
    samples[3] = std::numeric_limits<float>::quiet_NaN();
    samples[4] = -std::numeric_limits<float>::infinity();
    gate.process(samples);
    for (const float sample : samples) {
        ASSERT_EQ(sample, 0.0F);
        ASSERT_FALSE(std::signbit(sample));
    }
}

TEST(GateTest, AnOpenGateLeavesTheSignalUnchanged) {
    Gate gate(48000.0);
    gate.open();
    std::vector<float> samples = whiteNoise(1000, 10.0, 34);
    const std::vector<float> original = samples;
    gate.process(samples);
    EXPECT_TRUE(std::equal(samples.begin() + 96, samples.end(), original.begin() + 96));
    EXPECT_FALSE(std::equal(samples.begin(), samples.begin() + 90, original.begin()));
}

TEST(GateTest, UnsupportedRatesAreRejected) {
    EXPECT_THROW(Gate{0.0}, std::invalid_argument);
    EXPECT_THROW(Gate{std::numeric_limits<double>::quiet_NaN()}, std::invalid_argument);
}

TEST(LevelSmootherTest, TheGainReachesItsTargetExactlyAndLinearlyWithinTheRamp) {
    LevelSmoother smoother(48000.0, 0.01, 1.0F);
    smoother.setTarget(0.3F);
    for (int i = 1; i < 480; ++i) {
        ASSERT_NEAR(smoother.next(), 1.0 - 0.7 * i / 480.0, 1e-6);
        ASSERT_FALSE(smoother.isSettled());
    }
    EXPECT_EQ(smoother.next(), 0.3F);
    EXPECT_TRUE(smoother.isSettled());
    EXPECT_EQ(smoother.next(), 0.3F);
}

TEST(LevelSmootherTest, NewTargetsAtAnySampleNeverMakeAStepLargerThanTheRangeOverTheRamp) {
    LevelSmoother smoother(48000.0, 0.01, 1.0F);
    Uniform uniform(51);
    double previous = 1.0;
    for (int i = 0; i < 100000; ++i) {
        if (uniform(0.0, 1.0) < 0.1) {
            smoother.setTarget(static_cast<float>(uniform(0.0, 2.0)));
        }
        const double gain = smoother.next();
        ASSERT_LE(std::abs(gain - previous), 2.0 / 480.0 + 1e-6);
        ASSERT_GE(gain, 0.0);
        ASSERT_LE(gain, 2.0);
        previous = gain;
    }
}

TEST(LevelSmootherTest, ANonFiniteTargetIsIgnored) {
    LevelSmoother smoother(48000.0);
    smoother.setTarget(std::numeric_limits<float>::quiet_NaN());
    smoother.setTarget(std::numeric_limits<float>::infinity());
    smoother.reset(std::numeric_limits<float>::quiet_NaN());
    EXPECT_EQ(smoother.target(), 1.0F);
    EXPECT_EQ(smoother.next(), 1.0F);
}

TEST(LevelSmootherTest, ProcessMultipliesSampleBySampleAndAUnityGainChangesNothing) {
    std::vector<float> samples = whiteNoise(300, 10.0, 52);
    const std::vector<float> original = samples;
    LevelSmoother smoother(2000.0);
    smoother.process(samples);
    EXPECT_EQ(samples, original);

    LevelSmoother twin(2000.0);
    smoother.setTarget(0.5F);
    twin.setTarget(0.5F);
    smoother.process(samples);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        ASSERT_EQ(samples[i], original[i] * twin.next());
    }
    EXPECT_EQ(samples.back(), original.back() * 0.5F);
}

TEST(LevelSmootherTest, ResetSetsTheGainAtOnce) {
    LevelSmoother smoother(48000.0);
    smoother.setTarget(0.0F);
    smoother.reset(0.25F);
    EXPECT_EQ(smoother.next(), 0.25F);
    EXPECT_TRUE(smoother.isSettled());
}

TEST(LevelSmootherTest, InvalidSettingsAreRejected) {
    EXPECT_THROW(LevelSmoother(0.0), std::invalid_argument);
    EXPECT_THROW(LevelSmoother(48000.0, -0.1), std::invalid_argument);
    EXPECT_THROW(LevelSmoother(48000.0, 0.01, std::numeric_limits<float>::quiet_NaN()), std::invalid_argument);
}

struct SeamPower {
    double before = 0.0;
    double seam = 0.0;
};

// Mean power of unit-level signals outside the seam and within it, over many seams. The successor contains `share` of
// the continuation, so that `share` is their correlation.
SeamPower seamPower(double share, std::size_t length) {
    SeamPower power;
    constexpr std::size_t seams = 20000;
    constexpr std::size_t window = Splice::correlationSamples;
    const std::vector<float> noise = whiteNoise(2 * seams * window, std::sqrt(3.0), 4);
    const double own = std::sqrt(1.0 - share * share);
    for (std::size_t seam = 0; seam < seams; ++seam) {
        const auto old = std::span(noise).subspan(2 * seam * window, window);
        const auto other = std::span(noise).subspan((2 * seam + 1) * window, window);
        std::vector<float> successor(other.begin(), other.end());
        for (std::size_t i = 0; i < successor.size(); ++i) {
            successor[i] = static_cast<float>(share * old[i] + own * successor[i]);
        }
        Splice splice;
        splice.begin(old, successor, length);
        for (std::size_t i = 0; i < length; ++i) {
            const double value = splice.next(old[i], successor[i]);
            power.seam += value * value / static_cast<double>(length * seams);
            power.before += static_cast<double>(old[i]) * old[i] / static_cast<double>(length * seams);
        }
    }
    return power;
}

TEST(SpliceTest, TheLevelIsConstantAcrossTheSeamForAnyCorrelation) {
    for (const double share : {0.0, 0.5, 0.9}) {
        for (const std::size_t length : {1U, 2U, 4U}) {
            const SeamPower power = seamPower(share, length);
            const double change = 10.0 * std::log10(power.seam / power.before);
            // The tolerance allows for the clamp at 0: a random positive correlation within 32 samples lowers the gain,
            // and a negative one cannot raise it.
            EXPECT_NEAR(change, 0.0, 0.4) << "correlation " << share << ", " << length << " samples";
        }
    }
}

TEST(SpliceTest, AfterTheSpliceTheSuccessorPassesUnchanged) {
    const std::vector<float> old = whiteNoise(40, 1.0, 6);
    const std::vector<float> successor = whiteNoise(40, 1.0, 7);
    Splice splice;
    splice.begin(old, successor, 4);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_TRUE(splice.active());
        EXPECT_NE(splice.next(old[i], successor[i]), successor[i]);
    }
    EXPECT_FALSE(splice.active());
    EXPECT_EQ(splice.next(1e9F, successor[4]), successor[4]);
}

TEST(SpliceTest, ALengthOfZeroSwitchesAtOnceAndTheLengthIsLimitedToFour) {
    const std::vector<float> old(40, 1.0F);
    const std::vector<float> successor(40, 2.0F);
    Splice splice;
    splice.begin(old, successor, 0);
    EXPECT_FALSE(splice.active());
    splice.begin(old, successor, 99);
    int length = 0;
    for (; splice.active(); ++length) {
        (void)splice.next(1.0F, 2.0F);
    }
    EXPECT_EQ(length, 4);
    splice.begin(std::span(old).first(2), successor, 4);
    for (length = 0; splice.active(); ++length) {
        (void)splice.next(1.0F, 2.0F);
    }
    EXPECT_EQ(length, 2) << "limited to the length of the continuation";
}

TEST(SpliceTest, SilenceOnEitherSideGivesFiniteGainsOfAtMostOne) {
    const std::vector<float> silence(40, 0.0F);
    const std::vector<float> loud = whiteNoise(40, 50.0, 8);
    for (const auto& [old, successor] : {std::pair{silence, silence}, {silence, loud}, {loud, silence}}) {
        Splice splice;
        splice.begin(old, successor, 4);
        for (std::size_t i = 0; i < 4; ++i) {
            const float value = splice.next(old[i], successor[i]);
            ASSERT_TRUE(std::isfinite(value));
            const double share = static_cast<double>(i + 1) / 5.0;
            EXPECT_NEAR(value, (1.0 - share) * old[i] + share * successor[i], 1e-5)
                << "the gains exceed those of a linear crossfade";
        }
    }
}

TEST(SpliceTest, TheCorrelationIsOneForScaledCopiesAndZeroForOppositesWithin32Samples) {
    std::vector<float> waveform = whiteNoise(64, 1.0, 9);
    std::vector<float> louder = waveform;
    std::vector<float> opposite = waveform;
    for (std::size_t i = 0; i < waveform.size(); ++i) {
        louder[i] *= 4.0F;
        opposite[i] *= -1.0F;
    }
    EXPECT_DOUBLE_EQ(spliceCorrelation(waveform, waveform), 1.0);
    EXPECT_NEAR(spliceCorrelation(waveform, louder), 1.0, 1e-12);
    EXPECT_EQ(spliceCorrelation(waveform, opposite), 0.0);
    const double before = spliceCorrelation(waveform, louder);
    louder[40] = 1e6F;
    EXPECT_EQ(spliceCorrelation(waveform, louder), before);
}

TEST(SpliceTest, ANonFiniteSampleGivesFiniteGains) {
    std::vector<float> old = whiteNoise(40, 1.0, 10);
    const std::vector<float> successor = whiteNoise(40, 1.0, 11);
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        old[20] = bad;
        Splice splice;
        splice.begin(old, successor, 4);
        EXPECT_TRUE(std::isfinite(splice.next(old[0], successor[0])));
    }
}

}  // namespace
}  // namespace haptoflow::dsp
