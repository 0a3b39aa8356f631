#include "effects/perceived_intensity.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace haptoflow::effects {
namespace {

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

TEST(PerceivedIntensityTest, IntensityGrowsWithAmplitudeAndHighContoursAreParallel) {
    for (const double frequencyHz : {30.0, 60.0, 160.0, 250.0}) {
        double last = 0.0;
        for (double amplitude = 1e-3; amplitude < 1000.0; amplitude *= 1.1) {
            const double intensity = intensityOfSinusoid(amplitude, frequencyHz);
            EXPECT_GT(intensity, last);
            last = intensity;
        }
    }
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
