#include "effects/wave_features.hpp"

#include "support/counting_new.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

namespace haptoflow::effects {
namespace {

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
