#include "dsp/splice.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "test_signals.hpp"

namespace haptoflow::dsp {
namespace {

using testing::whiteNoise;

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
