#include "skeleton/excitation.hpp"

#include "skeleton/reflection_filter.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <random>

namespace haptoflow::skeleton {
namespace {

FamilyGains randomGains(std::uint32_t seed) {
    std::mt19937 random(seed);
    std::normal_distribution<float> normal;
    FamilyGains gains;
    const auto draw = [&] { return normal(random); };
    std::ranges::generate(gains.swingCosine, draw);
    std::ranges::generate(gains.swingSine, draw);
    std::ranges::generate(gains.lineCosine, draw);
    std::ranges::generate(gains.lineSine, draw);
    return gains;
}

/// The angle of a harmonic at sample n, straight from the definition.
double theta(const FamilyPhase& phase, std::size_t harmonic, double n) {
    const double sign = phase.rateHz >= 0.0 ? 1.0 : -1.0;
    return 2.0 * std::numbers::pi * static_cast<double>(harmonic) *
           (sign * phase.cycles + std::fabs(phase.rateHz) * (n + 0.5) / 2000.0);
}

void expectDefinition(const FamilyPhase& phase) {
    const FamilyGains gains = randomGains(11);
    NetworkInput input;
    for (std::size_t n = 0; n < segmentSamples; ++n) {
        // Pieces of 32 samples, and one of 8.
        const std::size_t first = n - n % pieceSamples;
        SurfaceWaves waves(std::min(pieceSamples, segmentSamples - first));
        waves.add({.cycles = phase.cycles + phase.rateHz * static_cast<double>(first) / 2000.0, .rateHz = phase.rateHz},
                  gains, {.input = n == first ? &input : nullptr, .first = first});
        double line = 0.0;
        double swing = 0.0;
        for (std::size_t h = 1; h <= lineHarmonics; ++h) {
            const double angle = theta(phase, h, static_cast<double>(n));
            const double harmonicHz = static_cast<double>(h) * std::fabs(phase.rateHz);
            if (harmonicHz < 960.0) {
                line += 30.0 * std::tanh(gains.lineCosine[h - 1] / 30.0) * std::cos(angle) +
                        30.0 * std::tanh(gains.lineSine[h - 1] / 30.0) * std::sin(angle);
            }
            if (h <= swingHarmonics) {
                const bool isHeard = harmonicHz < 700.0;
                swing += isHeard ? gains.swingCosine[h - 1] * std::cos(angle) + gains.swingSine[h - 1] * std::sin(angle)
                                 : 0.0;
                ASSERT_NEAR(input.piece(h + 1, n, 1)[0], isHeard ? std::cos(angle) : 0.0, 3e-6) << h << ' ' << n;
                ASSERT_NEAR(input.piece(h + 6, n, 1)[0], isHeard ? std::sin(angle) : 0.0, 3e-6) << h << ' ' << n;
            }
        }
        ASSERT_NEAR(waves.lines()[n - first], line, 2e-5) << n;
        ASSERT_NEAR(waves.swing()[n - first], swing, 2e-5) << n;
    }
}

TEST(SurfaceWavesTest, LinesSwingAndPulsesFollowTheDefinitionForwardsBackwardsAndAfterManyTurns) {
    for (const double rateHz : {0.6, 37.5, 91.0, 333.0, 650.0, 959.0, -37.5, -210.0}) {
        expectDefinition({.cycles = 0.3, .rateHz = rateHz});
    }
    expectDefinition({.cycles = 1e6 + 0.25, .rateHz = 90.0});
}

TEST(SurfaceWavesTest, OnlyRatesBetweenHalfAHertzAndTheHighestLineAreHeard) {
    EXPECT_FALSE(isHeardHz(0.0));
    EXPECT_FALSE(isHeardHz(-0.5));
    EXPECT_TRUE(isHeardHz(-0.51));
    EXPECT_TRUE(isHeardHz(959.9));
    EXPECT_FALSE(isHeardHz(960.0));
    EXPECT_FALSE(isHeardHz(std::numeric_limits<double>::quiet_NaN()));
}

using Gains = std::array<float, TailImpulses::gainCount>;
using Ringing = TailImpulses::Ringing;

/// Of the positive tail.
Gains withGain(std::size_t threshold, std::size_t atom, float gain) {
    Gains gains{};
    gains[threshold * atomCount + atom] = gain;
    return gains;
}

Ringing impulsesOf(const Piece& noise, const Gains& gains) {
    Ringing ringing{};
    TailImpulses().add(noise, gains, ringing);
    return ringing;
}

TEST(TailImpulsesTest, NoiseBelowTheFirstThresholdMakesNoImpulse) {
    Piece noise{};
    noise[10] = 2.0F;
    noise[20] = -1.99F;
    Gains gains{};
    gains.fill(1.0F);
    EXPECT_EQ(impulsesOf(noise, gains), Ringing{});
}

TEST(TailImpulsesTest, AHighSampleExceedsEveryThresholdBelowIt) {
    Piece noise{};
    noise[10] = 3.3F;
    for (std::size_t threshold = 0; threshold < thresholdCount; ++threshold) {
        EXPECT_EQ(impulsesOf(noise, withGain(threshold, 0, 1.0F))[10] > 0.0F, threshold < 3) << threshold;
    }
}

TEST(TailImpulsesTest, AStrikeAtAPiecesEndRingsOnAndAddsToWhatRings) {
    Piece noise{};
    noise.back() = 2.5F;
    Ringing ringing{};
    ringing.fill(1.0F);
    TailImpulses().add(noise, withGain(0, 8, 3.0F), ringing);
    EXPECT_EQ(ringing[pieceSamples - 2], 1.0F);
    EXPECT_NE(ringing[pieceSamples + 10], 1.0F);
    EXPECT_EQ(ringing.back(), 1.0F);
}

using Reflections = std::array<float, filterOrder>;
using Past = std::array<double, filterOrder>;

double logCosh(double x) {
    return std::log(std::cosh(x));
}

/// Gain of 1 / A at a frequency.
double gainAt(const ReflectionFilter& filter, double frequencyHz) {
    std::complex<double> a = 1.0;
    for (std::size_t i = 0; i < filterOrder; ++i) {
        a += filter.coefficients[i] *
             std::polar(1.0, -2.0 * std::numbers::pi * frequencyHz * static_cast<double>(i + 1) / waveformRateHz);
    }
    return 1.0 / std::abs(a);
}

TEST(ReflectionFilterTest, ResonanceBeyondFiftyDecibelsIsScaledDown) {
    Reflections outputs{};
    outputs.fill(2.0F);
    const double resonance = 24.0 * logCosh(2.0);
    const double limit = std::log(std::pow(10.0, 2.5));
    ASSERT_GT(resonance, limit);
    const auto filter = ReflectionFilter::of(outputs, 0.0F);
    const double scaled = 2.0 * limit / resonance;
    EXPECT_NEAR(filter.coefficients.back(), std::tanh(scaled) * std::pow(0.985, 24), 1e-7);
    EXPECT_NEAR(filter.logGain, -24.0 * logCosh(scaled), 1e-6);
}

TEST(ReflectionFilterTest, OneReflectionIsLimitedTo3Point8) {
    Reflections outputs{};
    outputs[0] = -1e6F;
    EXPECT_NEAR(ReflectionFilter::of(outputs, 0.0F).coefficients[0], -std::tanh(3.8) * 0.985, 1e-7);
}

TEST(ReflectionFilterTest, OnlyTheOutputIsLimitedNotTheRecursion) {
    Reflections outputs{};
    outputs[0] = -1.0F;
    const auto filter = ReflectionFilter::of(outputs, 0.0F);
    Piece drive{};
    drive[0] = 160.0F;
    Piece filtered{};
    Past past{};
    filter.run(past, drive, filtered);
    const double ratio = std::tanh(1.0) * 0.985;
    EXPECT_EQ(filtered[0], 64.0F);
    EXPECT_EQ(filtered[1], 64.0F);
    EXPECT_NEAR(filtered[5], 160.0 * std::pow(ratio, 5), 1e-4);
}

TEST(ReflectionFilterTest, AnyReflectionsDecayAndResonateAtMostFiftyDecibelsAboveTheirMean) {
    std::mt19937 random(7);
    std::normal_distribution<float> normal;
    for (int trial = 0; trial < 40; ++trial) {
        const float strength = std::pow(10.0F, static_cast<float>(trial % 8) - 3.0F);
        Reflections outputs{};
        std::ranges::generate(outputs, [&] { return strength * normal(random); });
        const auto filter = ReflectionFilter::of(outputs, 0.0F);
        Past past{};
        past.back() = 1.0F;
        Piece filtered{};
        double largest = 0.0;
        double energy = 0.0;
        for (int piece = 0; piece < 625; ++piece) {
            filter.run(past, Piece{}, filtered);
            energy = 0.0;
            for (const float sample : filtered) {
                ASSERT_TRUE(std::isfinite(sample));
                energy += static_cast<double>(sample) * static_cast<double>(sample);
            }
            largest = std::max(largest, energy);
        }
        EXPECT_LT(energy, 1e-6 * largest + 1e-12) << "trial " << trial << " still rings after 10 s";
        // Noise of this gain through the filter has a mean power of at most 1: the gain takes out the reflections' own.
        double power = 0.0;
        for (int bin = 0; bin < 4000; ++bin) {
            const double gain = gainAt(filter, (bin + 0.5) * 0.25);
            power += gain * gain / 4000.0;
        }
        EXPECT_LT(power * std::exp(2.0 * filter.logGain), 1.01) << trial;
    }
}

TEST(ReflectionFilterTest, OutputsThatAreNotNumbersAreNotSpread) {
    Reflections outputs{};
    outputs[4] = std::numeric_limits<float>::infinity();
    outputs[5] = -std::numeric_limits<float>::infinity();
    const auto filter = ReflectionFilter::of(outputs, std::numeric_limits<float>::infinity());
    EXPECT_TRUE(std::ranges::all_of(filter.coefficients, [](double each) { return std::isfinite(each); }));
    EXPECT_TRUE(std::isfinite(filter.logGain));
}

}  // namespace
}  // namespace haptoflow::skeleton
