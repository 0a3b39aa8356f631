#include "effects/carrier_rendering.hpp"

#include "effects/feature_signals.hpp"
#include "effects/perceived_intensity.hpp"
#include "effects/wave_features.hpp"
#include "support/counting_new.hpp"
#include "support/wave_measures.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <vector>

namespace haptoflow::effects {
namespace {

using testing::decayingSinusoidFrom;
using testing::featureSine;

WaveFeatureOptions touchPlus() {
    WaveFeatureOptions options;
    options.minFrequencyHz = 40.0;
    options.maxFrequencyHz = 400.0;
    return options;
}

WaveFeatureOptions motorOfOneFrequency() {
    WaveFeatureOptions options;
    options.frameSeconds = 0.008;
    options.minFrequencyHz = 160.0;
    options.maxFrequencyHz = 160.0;
    return options;
}

IntensityErrors errorOf(const std::vector<float>& wave, const WaveFeatureOptions& options,
                        CarrierShape shape = CarrierShape::held) {
    return intensityErrors(wave, renderCarrier(framesOf(wave, options), shape), options);
}

std::vector<WaveFrame> constantFrames(std::size_t count, float amplitude, float frequencyHz) {
    std::vector<WaveFrame> frames(count);
    for (std::size_t i = 0; i < count; ++i) {
        frames[i].firstSample = 10 * i;
        frames[i].sampleCount = 10;
        frames[i].amplitudeMps2 = amplitude;
        frames[i].frequencyHz = frequencyHz;
    }
    return frames;
}

TEST(CarrierRenderingTest, ARenderedSinusoidKeepsItsIntensityAtEveryFrequency) {
    for (const CarrierShape shape : {CarrierShape::held, CarrierShape::linear}) {
        for (double frequencyHz = 40.0; frequencyHz <= 400.0; frequencyHz += 20.0) {
            const std::vector<float> wave = featureSine(frequencyHz, 5.0, 1.0);
            const IntensityErrors own = errorOf(wave, touchPlus(), shape);
            const IntensityErrors motor = errorOf(wave, motorOfOneFrequency(), shape);
            EXPECT_GT(own.feltFrames, 190U);
            EXPECT_LT(own.meanMagnitudeDb, 0.6) << frequencyHz;
            EXPECT_LT(own.percentile95Db, 1.7) << frequencyHz;
            EXPECT_LT(motor.meanMagnitudeDb, 0.6) << frequencyHz;
            EXPECT_LT(motor.percentile95Db, 1.0) << frequencyHz;
        }
    }
}

TEST(CarrierRenderingTest, ARenderedDecayingSinusoidKeepsItsIntensityInEachFrame) {
    for (const double frequencyHz : {80.0, 150.0, 250.0}) {
        for (std::size_t start = 200; start < 210; ++start) {
            const IntensityErrors error =
                errorOf(decayingSinusoidFrom(start, frequencyHz, 60.0, 60.0, 0.5), touchPlus());
            EXPECT_LT(error.meanMagnitudeDb, 2.0) << frequencyHz << " Hz from " << start;
            EXPECT_LT(error.percentile95Db, 5.0) << frequencyHz << " Hz from " << start;
        }
    }
}

TEST(CarrierRenderingTest, FramesFeltInNeitherWaveAreSkippedAndMissingFramesCount) {
    const std::vector<float> faint = featureSine(160.0, 0.01, 1.0);
    EXPECT_EQ(intensityErrors(faint, faint).feltFrames, 0U);
    const std::vector<float> wave = featureSine(160.0, 5.0, 1.0);
    const IntensityErrors missing = intensityErrors(wave, {});
    EXPECT_GT(missing.feltFrames, 190U);
    EXPECT_LT(missing.meanDb, -30.0);
    EXPECT_TRUE(std::isfinite(missing.meanDb)) << "the played intensity counts as at least 1";
}

TEST(CarrierRenderingTest, ACarrierHasItsFramesAmplitudeFrequencyAndLength) {
    for (const CarrierShape shape : {CarrierShape::held, CarrierShape::linear}) {
        const std::vector<float> wave = renderCarrier(constantFrames(200, 3.0F, 120.0F), shape);
        ASSERT_EQ(wave.size(), 2000U);
        int crossings = 0;
        for (std::size_t i = 1; i < wave.size(); ++i) {
            crossings += (wave[i - 1] < 0.0F) != (wave[i] < 0.0F) ? 1 : 0;
        }
        EXPECT_NEAR(std::numbers::sqrt2 * haptoflow::testing::rms(wave), 3.0, 0.03);
        EXPECT_NEAR(crossings, 240, 2);
    }
}

TEST(CarrierRenderingTest, ACarrierIsContinuousInPhaseAndALinearOneInAmplitude) {
    std::vector<WaveFrame> frames = constantFrames(200, 1.0F, 100.0F);
    for (std::size_t i = 0; i < frames.size(); ++i) {
        frames[i].amplitudeMps2 = i % 3 == 0 ? 0.0F : 1.0F;
        frames[i].frequencyHz = i % 2 == 0 ? 20.0F : 100.0F;
    }
    const std::vector<float> wave = renderCarrier(frames, CarrierShape::linear);
    // The steepest sinusoid, and an amplitude that rises over the 10 samples between two middles.
    EXPECT_LT(haptoflow::testing::largestStep(wave), 2.0 * std::numbers::pi * 100.0 / 2000.0 + 0.1 + 1e-3);
}

TEST(CarrierRenderingTest, NoFramesGiveAnEmptyRendering) {
    EXPECT_TRUE(renderCarrier({}, CarrierShape::held).empty());
    EXPECT_TRUE(framesOf({}).empty());
}

TEST(CarrierRenderingTest, TheFramesOfAWholeWaveReachItsEnd) {
    for (const std::size_t length : {1U, 9U, 10U, 11U, 2000U}) {
        const std::vector<WaveFrame> frames = framesOf(std::vector<float>(length, 1.0F));
        ASSERT_FALSE(frames.empty());
        EXPECT_GE(frames.back().firstSample + frames.back().sampleCount, length);
        EXPECT_LT(frames.back().firstSample, length);
    }
}

/// The amplitude of a sinusoid of amplitude 1 after its decimation.
double decimatedAmplitude(std::size_t factor, double frequencyHz) {
    const auto length = static_cast<double>(factor);
    const std::vector<float> slow =
        effects::decimated(haptoflow::testing::sine(frequencyHz, 1.0, 2.0, 2000.0 * length), factor);
    return std::numbers::sqrt2 * haptoflow::testing::rms(std::span(slow).subspan(100, slow.size() - 200));
}

TEST(WaveDecimationTest, PerceptibleFrequenciesPassAndAliasesAreSuppressed) {
    for (const std::size_t factor : {2U, 3U, 4U, 24U}) {
        for (const double frequencyHz : {10.0, 60.0, 250.0, 500.0}) {
            EXPECT_NEAR(decimatedAmplitude(factor, frequencyHz), 1.0, 0.01) << frequencyHz;
        }
        for (const double frequencyHz : {1510.0, 1700.0, 1990.0}) {
            EXPECT_LT(decimatedAmplitude(factor, frequencyHz), 0.004) << frequencyHz;
        }
    }
}

TEST(WaveDecimationTest, AnImpulseIsDelayedByThreeSamplesOfTheNewRate) {
    WaveDecimation decimation(4);
    std::vector<float> result;
    for (int i = 0; i < 64; ++i) {
        float sample = 0.0F;
        // The fourth input sample completes the first output sample.
        if (decimation.take(i == 3 ? 1.0F : 0.0F, sample)) {
            result.push_back(sample);
        }
    }
    for (std::size_t i = 0; i < result.size(); ++i) {
        EXPECT_NEAR(result[i], i == WaveDecimation::delaySamples ? 0.25F : 0.0F, 0.02F) << i;
    }
}

TEST(WaveDecimationTest, AWholeWaveKeepsItsTimeAndItsLength) {
    std::vector<float> wave(64);
    wave[3] = 1.0F;
    const std::vector<float> slow = effects::decimated(wave, 4);
    ASSERT_EQ(slow.size(), 16U);
    EXPECT_NEAR(slow[0], 0.25F, 0.02F);
    EXPECT_EQ(effects::decimated(wave, 1), wave);
}

TEST(WaveDecimationTest, FactorsOutOfRangeAreRejectedAndSamplesAllocateNothing) {
    EXPECT_THROW(WaveDecimation(0), std::invalid_argument);
    EXPECT_THROW(WaveDecimation(97), std::invalid_argument);
    WaveDecimation decimation(8);
    const std::size_t before = haptoflow::testing::allocationCount();
    float sample = 0.0F;
    for (int i = 0; i < 100; ++i) {
        (void)decimation.take(1.0F, sample);
    }
    decimation.reset();
    EXPECT_EQ(haptoflow::testing::allocationCount(), before);
}

double displacementMicrometres(double frequencyHz) {
    const double turn = 2.0 * std::numbers::pi * frequencyHz;
    return 1e6 * detectionThresholdMps2(frequencyHz) / (turn * turn);
}

TEST(PerceivedIntensityTest, TheThresholdAgreesWithPublishedConstraints) {
    EXPECT_NEAR(displacementMicrometres(10.0), 26.0, 1.0) << "Israr, Choi and Tan 2006";
    double mostSensitiveHz = 0.0;
    double leastDisplacementHz = 0.0;
    double leastAcceleration = 1e9;
    double leastDisplacement = 1e9;
    for (double frequencyHz = 10.0; frequencyHz <= 1000.0; frequencyHz += 1.0) {
        if (detectionThresholdMps2(frequencyHz) < leastAcceleration) {
            leastAcceleration = detectionThresholdMps2(frequencyHz);
            mostSensitiveHz = frequencyHz;
        }
        if (displacementMicrometres(frequencyHz) < leastDisplacement) {
            leastDisplacement = displacementMicrometres(frequencyHz);
            leastDisplacementHz = frequencyHz;
        }
    }
    EXPECT_NEAR(mostSensitiveHz, 125.0, 1.0) << "Griffin 2012";
    EXPECT_GE(leastDisplacementHz, 150.0) << "Brisben, Hsiao and Johnson 1999";
    EXPECT_LE(leastDisplacementHz, 200.0);
    EXPECT_LT(leastDisplacement, 0.1);
    EXPECT_GT(leastDisplacement, 0.01);
    const double octaves = std::log2(150.0 / 20.0);
    EXPECT_GT(20.0 * std::log10(displacementMicrometres(20.0) / displacementMicrometres(150.0)) / octaves, 12.0);
}

TEST(PerceivedIntensityTest, TheExponentsFollowFromThresholdAndEqualVelocity) {
    for (const double frequencyHz : {30.0, 40.0, 60.0, 80.0, 125.0, 160.0, 200.0, 250.0, 320.0, 400.0}) {
        const double atContour = 2.0 * std::numbers::pi * frequencyHz * 0.005;
        const double exponent = std::log(contourIntensity) / std::log(atContour / detectionThresholdMps2(frequencyHz));
        EXPECT_NEAR(intensityExponent(frequencyHz), exponent, 0.01) << frequencyHz;
        EXPECT_NEAR(amplitudeOfIntensity(contourIntensity, frequencyHz) / atContour, 1.0, 0.05) << frequencyHz;
    }
    EXPECT_NEAR(intensityExponent(30.0) / intensityExponent(160.0), 2.0, 0.1) << "Stevens 1968";
    EXPECT_EQ(intensityExponent(1.0), intensityExponent(30.0));
    EXPECT_EQ(intensityExponent(900.0), intensityExponent(400.0));
}

TEST(PerceivedIntensityTest, TheInverseGivesBackEveryAmplitude) {
    for (double frequencyHz = 10.0; frequencyHz < 1000.0; frequencyHz *= 1.21) {
        for (double amplitude = 1e-4; amplitude < 1000.0; amplitude *= 3.1) {
            const double intensity = intensityOfSinusoid(amplitude, frequencyHz);
            EXPECT_NEAR(amplitudeOfIntensity(intensity, frequencyHz) / amplitude, 1.0, 1e-9)
                << amplitude << " m/s^2 at " << frequencyHz << " Hz";
        }
    }
}

TEST(PerceivedIntensityTest, HighContoursAreParallel) {
    const double atContour =
        amplitudeOfIntensity(contourIntensity, 160.0) / amplitudeOfIntensity(contourIntensity, 40.0);
    const double farAbove = amplitudeOfIntensity(1e4, 160.0) / amplitudeOfIntensity(1e4, 40.0);
    EXPECT_NEAR(farAbove / atContour, 1.0, 1e-9);
}

TEST(PerceivedIntensityTest, AnAmplitudeOfZeroOrLessHasNoIntensity) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    for (const double amplitude : {0.0, -1.0, nan}) {
        EXPECT_EQ(intensityOfSinusoid(amplitude, 100.0), 0.0);
        EXPECT_EQ(amplitudeOfIntensity(amplitude, 100.0), 0.0);
    }
    for (const double frequencyHz : {0.0, -5.0, nan}) {
        EXPECT_EQ(detectionThresholdMps2(frequencyHz), detectionThresholdMps2(1.0));
        EXPECT_TRUE(std::isfinite(intensityOfSinusoid(1.0, frequencyHz)));
    }
    EXPECT_EQ(detectionThresholdMps2(std::numeric_limits<double>::infinity()), detectionThresholdMps2(1000.0));
}

}  // namespace
}  // namespace haptoflow::effects
