#include "dsp/fourier_transform.hpp"

#include "dsp/tone_filter.hpp"
#include "support/wave_measures.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>
#include <stdexcept>
#include <vector>

namespace haptoflow::dsp {
namespace {

using haptoflow::testing::gainDecibels;
using haptoflow::testing::sinusoid;

/// Gain that rises from -8 dB at 50 Hz to 8 dB at 800 Hz, linearly over the logarithm of frequency.
double rising(double frequencyHz) {
    return -8.0 + 16.0 * std::log(std::clamp(frequencyHz, 50.0, 800.0) / 50.0) / std::log(16.0);
}

constexpr std::array<float, ToneFilter::memorySamples> silence{};
const ToneKernel kernel = toneKernel(toneCepstrum(rising));

TEST(ToneCepstrumTest, AGainOfZeroDecibelsGivesTheUnitImpulse) {
    const ToneKernel flat = toneKernel(toneCepstrum([](double) { return 0.0; }));
    EXPECT_NEAR(flat[0], 1.0F, 1e-6F);
    EXPECT_TRUE(std::all_of(flat.begin() + 1, flat.end(), [](float tap) { return std::abs(tap) < 1e-6F; }));
}

TEST(ToneCepstrumTest, TheKernelIsMinimumPhase) {
    // Of all filters with one magnitude, the minimum-phase filter has the largest first tap. Its logarithm is the mean
    // of the logarithmic gain over frequency.
    double mean = 0.0;
    for (int bin = 0; bin < 1000; ++bin) {
        mean += rising(static_cast<double>(bin) + 0.5) / 1000.0;
    }
    EXPECT_NEAR(20.0 * std::log10(static_cast<double>(kernel[0])), mean, 0.1);
}

TEST(ToneCepstrumTest, AddingCepstraAddsGainsInDecibels) {
    const ToneCepstrum first = toneCepstrum(rising);
    const ToneCepstrum second = toneCepstrum([](double frequencyHz) { return frequencyHz < 200.0 ? 3.0 : -2.0; });
    ToneCepstrum sum{};
    std::ranges::transform(first, second, sum.begin(), [](double a, double b) { return a + 0.5 * b; });
    EXPECT_NEAR(gainDecibels(toneKernel(sum), 100.0), rising(100.0) + 1.5, 0.5);
    EXPECT_NEAR(gainDecibels(toneKernel(sum), 600.0), rising(600.0) - 1.0, 0.5);
}

TEST(ToneFilterTest, WithoutAToneTheFilterIsInactiveAndChangesNothing) {
    ToneFilter filter;
    std::vector<float> samples = sinusoid(500, 100.0);
    const std::vector<float> before = samples;
    filter.reset(nullptr);
    filter.setTone(nullptr, silence);
    filter.process(samples);
    EXPECT_EQ(samples, before);
    EXPECT_FALSE(filter.isActive());
}

TEST(ToneFilterTest, ASinusoidGetsTheTonesGainAtItsFrequency) {
    for (const double frequencyHz : {60.0, 150.0, 400.0, 800.0}) {
        ToneFilter filter;
        filter.reset(&kernel);
        std::vector<float> samples = sinusoid(2000, frequencyHz);
        filter.process(samples);
        // A sinusoid of amplitude 1 has -3 dB.
        const double levelDb = haptoflow::testing::levelDecibels(std::span(samples).last(1000));
        EXPECT_NEAR(levelDb + 10.0 * std::log10(2.0), rising(frequencyHz), 0.4) << frequencyHz;
    }
}

TEST(ToneFilterTest, TheBlockLengthsDoNotChangeTheFilteredSignal) {
    ToneFilter whole;
    ToneFilter parts;
    whole.reset(&kernel);
    parts.reset(&kernel);
    std::vector<float> expected = sinusoid(400, 130.0);
    std::vector<float> found = expected;
    whole.process(expected);
    for (std::size_t first = 0, length = 1; first < found.size(); first += length, length = length % 7 + 1) {
        parts.process(std::span(found).subspan(first, std::min(length, found.size() - first)));
    }
    EXPECT_EQ(found, expected);
}

TEST(ToneFilterTest, AToneThatIsSwitchedOffFadesAndTheFilterBecomesInactive) {
    ToneFilter filter;
    filter.reset(&kernel);
    std::vector<float> samples = sinusoid(200, 100.0);
    filter.process(samples);
    filter.setTone(nullptr, silence);
    EXPECT_TRUE(filter.isActive());
    std::vector<float> rest(ToneFilter::fadeSamples + 1, 1.0F);
    filter.process(rest);
    EXPECT_FALSE(filter.isActive());
    EXPECT_EQ(rest.back(), 1.0F);
}

TEST(ToneFilterTest, AToneThatIsSwitchedOnContinuesFromThePlayedSamples) {
    ToneFilter always;
    always.reset(&kernel);
    std::vector<float> expected = sinusoid(400, 100.0);
    const std::vector<float> input = expected;
    always.process(expected);
    ToneFilter later;
    later.reset(nullptr);
    std::array<float, ToneFilter::memorySamples> past{};
    std::copy_n(input.begin() + 200 - static_cast<std::ptrdiff_t>(past.size()), past.size(), past.begin());
    later.setTone(&kernel, past);
    std::vector<float> found(input.begin() + 200, input.end());
    later.process(found);
    for (std::size_t i = ToneFilter::fadeSamples; i < found.size(); ++i) {
        ASSERT_NEAR(found[i], expected[200 + i], 1e-5F) << i;
    }
}

TEST(FourierTransformTest, TheResultEqualsTheDefiningSumAndTheInverseRestoresTheInput) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    std::vector<std::complex<double>> values(64);
    for (std::complex<double>& value : values) {
        value = {uniform(random), uniform(random)};
    }
    std::vector<std::complex<double>> transformed = values;
    fourierTransform(transformed, Direction::forward);
    for (std::size_t bin = 0; bin < values.size(); ++bin) {
        std::complex<double> sum = 0.0;
        for (std::size_t i = 0; i < values.size(); ++i) {
            sum += values[i] * std::polar(1.0, -2.0 * std::numbers::pi * static_cast<double>(bin * i) / 64.0);
        }
        EXPECT_NEAR(std::abs(transformed[bin] - sum), 0.0, 1e-12) << bin;
    }
    fourierTransform(transformed, Direction::inverse);
    for (std::size_t i = 0; i < values.size(); ++i) {
        EXPECT_NEAR(std::abs(transformed[i] - values[i]), 0.0, 1e-13) << i;
    }
}

TEST(FourierTransformTest, LengthsThatAreNotAPowerOfTwoAreRejected) {
    for (const std::size_t length : {0U, 3U, 100U}) {
        std::vector<std::complex<double>> values(length);
        EXPECT_THROW(fourierTransform(values, Direction::forward), std::invalid_argument) << length;
    }
}

}  // namespace
}  // namespace haptoflow::dsp
