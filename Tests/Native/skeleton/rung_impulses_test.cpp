#include "skeleton/excitation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace haptoflow::skeleton {
namespace {

using Gains = std::array<float, RungImpulses::gainCount>;
using Wave = std::array<float, segmentSamples>;

/// 1 over the deviation of max(n - 2, 0) - max(-n - 2, 0): E = 2 [(1 + 4) Q(2) - 2 p(2)].
const double scaleOfFirstRung = 1.0 / std::sqrt(2.0 * (5.0 * 0.022750131948179 - 2.0 * 0.053990966513188));

Gains withGain(bool isNegative, std::size_t rung, std::size_t atom, float gain) {
    Gains gains{};
    gains[((isNegative ? rungCount : 0) + rung) * atomCount + atom] = gain;
    return gains;
}

Wave struckBy(const Wave& noise, const Gains& gains) {
    Wave struck{};
    struck.fill(9.0F);
    RungImpulses().strike(noise, gains, struck);
    return struck;
}

TEST(RungImpulsesTest, NoiseBelowTheFirstRungStrikesNothing) {
    Wave noise{};
    noise[10] = 2.0F;
    noise[20] = -1.99F;
    Gains gains{};
    gains.fill(1.0F);
    EXPECT_EQ(struckBy(noise, gains), Wave{});
}

TEST(RungImpulsesTest, AStrikeOfTheDeltaIsTheScaledExcess) {
    Wave noise{};
    noise[10] = 2.5F;
    const Wave struck = struckBy(noise, withGain(false, 0, 0, 3.0F));
    EXPECT_NEAR(struck[10], 0.5 * scaleOfFirstRung * 8.0 * std::tanh(3.0 / 8.0), 1e-4);
    EXPECT_EQ(std::ranges::count(struck, 0.0F), 199);
}

TEST(RungImpulsesTest, TheNegativeTailStrikesDownwardsWithKernelsOfItsOwn) {
    Wave noise{};
    noise[10] = -2.5F;
    EXPECT_EQ(struckBy(noise, withGain(false, 0, 0, 3.0F)), Wave{});
    const Wave struck = struckBy(noise, withGain(true, 0, 0, 3.0F));
    EXPECT_NEAR(struck[10], -0.5 * scaleOfFirstRung * 8.0 * std::tanh(3.0 / 8.0), 1e-4);
}

TEST(RungImpulsesTest, ARingDecaysWithItsFrequencyFor64Samples) {
    Wave noise{};
    noise[10] = 2.0F + static_cast<float>(1.0 / scaleOfFirstRung);
    // The sine of 280 Hz.
    const Wave struck = struckBy(noise, withGain(false, 0, 8, 0.01F));
    const auto ring = [](std::size_t n) {
        const double turn = 2.0 * std::numbers::pi * 280.0 * static_cast<double>(n) / 2000.0;
        return std::exp(-0.4 * turn) * std::sin(turn);
    };
    double energy = 0.0;
    for (std::size_t n = 0; n < 64; ++n) {
        energy += ring(n) * ring(n);
    }
    for (std::size_t n = 0; n < 64; ++n) {
        EXPECT_NEAR(struck[10 + n], 0.01 * ring(n) / std::sqrt(energy), 1e-6) << n;
    }
    EXPECT_EQ(struck[9], 0.0F);
    EXPECT_EQ(struck[74], 0.0F);
}

TEST(RungImpulsesTest, AHighSampleStrikesEveryRungBelowIt) {
    Wave noise{};
    noise[10] = 3.3F;
    for (std::size_t rung = 0; rung < rungCount; ++rung) {
        EXPECT_EQ(struckBy(noise, withGain(false, rung, 0, 1.0F))[10] > 0.0F, rung < 3) << rung;
    }
}

TEST(RungImpulsesTest, AStrikeNearTheEndIsCutAtTheSegmentsEnd) {
    Wave noise{};
    noise[199] = 5.0F;
    Gains gains{};
    gains.fill(1.0F);
    const Wave struck = struckBy(noise, gains);
    EXPECT_NE(struck[199], 0.0F);
    EXPECT_EQ(struck[198], 0.0F);
}

}  // namespace
}  // namespace haptoflow::skeleton
