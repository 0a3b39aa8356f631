#include "effects/carrier_rendering.hpp"

#include "effects/feature_signals.hpp"
#include "effects/perceived_intensity.hpp"
#include "effects/wave_features.hpp"
#include "support/counting_new.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
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
        double squares = 0.0;
        int crossings = 0;
        for (std::size_t i = 1; i < wave.size(); ++i) {
            squares += static_cast<double>(wave[i]) * static_cast<double>(wave[i]);
            crossings += (wave[i - 1] < 0.0F) != (wave[i] < 0.0F) ? 1 : 0;
        }
        EXPECT_NEAR(std::sqrt(2.0 * squares / static_cast<double>(wave.size())), 3.0, 0.03);
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
    float largest = 0.0F;
    for (std::size_t i = 1; i < wave.size(); ++i) {
        largest = std::max(largest, std::abs(wave[i] - wave[i - 1]));
    }
    // The steepest sinusoid, and an amplitude that rises over the 10 samples between two middles.
    EXPECT_LT(static_cast<double>(largest), 2.0 * std::numbers::pi * 100.0 / 2000.0 + 0.1 + 1e-3);
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

std::vector<float> decimated(WaveDecimation& decimation, std::size_t factor, double frequencyHz) {
    std::vector<float> result;
    const double inputRateHz = 2000.0 * static_cast<double>(factor);
    for (std::size_t i = 0; i < 4000 * factor; ++i) {
        float sample = 0.0F;
        const double phase = 2.0 * std::numbers::pi * frequencyHz * static_cast<double>(i) / inputRateHz;
        if (decimation.take(static_cast<float>(std::sin(phase)), sample)) {
            result.push_back(sample);
        }
    }
    return result;
}

double amplitudeOf(const std::vector<float>& wave) {
    double power = 0.0;
    for (std::size_t i = 100; i < wave.size(); ++i) {
        power += std::pow(static_cast<double>(wave[i]), 2.0);
    }
    return std::sqrt(2.0 * power / static_cast<double>(wave.size() - 100));
}

TEST(WaveDecimationTest, PerceptibleFrequenciesPassAndAliasesAreSuppressed) {
    for (const std::size_t factor : {2U, 3U, 4U, 24U}) {
        WaveDecimation decimation(factor);
        for (const double frequencyHz : {10.0, 60.0, 250.0, 500.0}) {
            EXPECT_NEAR(amplitudeOf(decimated(decimation, factor, frequencyHz)), 1.0, 0.01) << frequencyHz;
            decimation.reset();
        }
        for (const double frequencyHz : {1510.0, 1700.0, 1990.0}) {
            EXPECT_LT(amplitudeOf(decimated(decimation, factor, frequencyHz)), 0.004) << frequencyHz;
            decimation.reset();
        }
    }
}

TEST(WaveDecimationTest, AFactorOfOneLeavesTheWaveUnchanged) {
    WaveDecimation decimation(1);
    for (const float sample : {0.0F, 0.3F, -7.0F}) {
        float same = 99.0F;
        EXPECT_TRUE(decimation.take(sample, same));
        EXPECT_EQ(same, sample);
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

}  // namespace
}  // namespace haptoflow::effects
