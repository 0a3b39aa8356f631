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

TEST(ReflectionFilterTest, TwoReflectionsGiveTheCoefficientsWorkedOutByHand) {
    const Reflections outputs{0.5F, -0.25F};
    const auto filter = ReflectionFilter::of(outputs, 0.8F);
    const double k1 = std::tanh(0.5);
    const double k2 = std::tanh(-0.25);
    EXPECT_NEAR(filter.coefficients[0], (k1 + k2 * k1) * 0.985, 1e-7);
    EXPECT_NEAR(filter.coefficients[1], k2 * 0.985 * 0.985, 1e-7);
    EXPECT_EQ(filter.coefficients[2], 0.0);
    EXPECT_NEAR(filter.logGain, 2.0 * std::tanh(0.4) - logCosh(0.5) - logCosh(0.25), 1e-7);
}

TEST(ReflectionFilterTest, ThreeReflectionsAreReversedAtEachStep) {
    const Reflections outputs{0.5F, -0.25F, 0.75F};
    const auto filter = ReflectionFilter::of(outputs, 0.0F);
    const double k1 = std::tanh(0.5);
    const double k2 = std::tanh(-0.25);
    const double k3 = std::tanh(0.75);
    const double first = k1 + k2 * k1;
    EXPECT_NEAR(filter.coefficients[0], (first + k3 * k2) * 0.985, 1e-7);
    EXPECT_NEAR(filter.coefficients[1], (k2 + k3 * first) * 0.985 * 0.985, 1e-7);
    EXPECT_NEAR(filter.coefficients[2], k3 * 0.985 * 0.985 * 0.985, 1e-7);
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

TEST(ReflectionFilterTest, APieceContinuesItsPastAndBecomesTheNextOnes) {
    Reflections outputs{};
    outputs[0] = -1.0F;
    const auto filter = ReflectionFilter::of(outputs, 0.0F);
    Past past{};
    past.back() = 2.0F;
    Piece filtered{};
    filter.run(past, Piece{}, filtered);
    const double ratio = std::tanh(1.0) * 0.985;
    EXPECT_NEAR(filtered[0], 2.0 * ratio, 1e-6);
    EXPECT_NEAR(filtered[9], 2.0 * std::pow(ratio, 10), 1e-6);
    filter.run(past, std::array<float, 1>{}, filtered);
    EXPECT_NEAR(filtered[0], 2.0 * std::pow(ratio, pieceSamples + 1), 1e-6);
}

TEST(ReflectionFilterTest, EveryTapReachesItsOwnSample) {
    std::mt19937 random(3);
    std::normal_distribution<float> normal;
    Reflections outputs{};
    Past past{};
    Piece drive{};
    std::ranges::generate(outputs, [&] { return 0.4F * normal(random); });
    std::ranges::generate(past, [&] { return normal(random); });
    std::ranges::generate(drive, [&] { return 0.2F * normal(random); });
    const auto filter = ReflectionFilter::of(outputs, 0.0F);
    std::vector<double> wave(past.begin(), past.end());
    Piece filtered{};
    filter.run(past, drive, filtered);
    for (std::size_t n = 0; n < pieceSamples; ++n) {
        double y = drive[n];
        for (std::size_t i = 0; i < filterOrder; ++i) {
            y -= filter.coefficients[i] * wave[wave.size() - 1 - i];
        }
        wave.push_back(y);
        ASSERT_NEAR(filtered[n], y, 1e-5) << n;
    }
}

TEST(ReflectionFilterTest, OnlyTheOutputIsLimitedNotTheRecursion) {
    Reflections outputs{};
    outputs[0] = -1.0F;
    const auto filter = ReflectionFilter::of(outputs, 0.0F);
    Piece drive{};
    drive[0] = 40.0F;
    Piece filtered{};
    Past past{};
    filter.run(past, drive, filtered);
    const double ratio = std::tanh(1.0) * 0.985;
    EXPECT_EQ(filtered[0], 16.0F);
    EXPECT_EQ(filtered[1], 16.0F);
    EXPECT_NEAR(filtered[5], 40.0 * std::pow(ratio, 5), 1e-5);
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
