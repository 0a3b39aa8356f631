#include "dsp/tone_filter.hpp"
#include "dsp/waveform_resampler.hpp"
#include "test_signals.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>

namespace haptoflow::dsp {
namespace {

using testing::Uniform;
using testing::whiteNoise;

constexpr double everyOutputRate[] = {8000.0,  11025.0, 16000.0,  22050.0, 24000.0,  44100.0,
                                      48000.0, 96000.0, 192000.0, 44101.0, 47999.97, 12345.678};

TEST(ResamplerPhaseTest, TheBlockLengthsDoNotChangeTheOutputAndInputNeededIsExact) {
    for (const double rate : everyOutputRate) {
        const std::vector<float> input = whiteNoise(600, 1.0, 21);
        WaveformResampler whole(rate);
        std::vector<float> expected(static_cast<std::size_t>(rate / 4.0));
        const std::size_t total = whole.inputNeeded(expected.size());
        ASSERT_LE(total, input.size());
        whole.process(std::span(input).first(total), expected);

        WaveformResampler blocks(rate);
        std::vector<float> output(expected.size());
        Uniform uniform(22);
        std::size_t produced = 0;
        std::size_t consumed = 0;
        while (produced < output.size()) {
            const std::size_t count = std::min(uniform.whole(0, 300), output.size() - produced);
            const std::size_t needed = blocks.inputNeeded(count);
            blocks.process(std::span(input).subspan(consumed, needed), std::span(output).subspan(produced, count));
            produced += count;
            consumed += needed;
        }
        EXPECT_EQ(consumed, total) << rate;
        EXPECT_EQ(output, expected) << rate;
    }
}

TEST(ResamplerPhaseTest, ADayOfOutputConsumesExactlyADayOfInput) {
    for (const double rate : {8000.0, 11025.0, 22050.0, 44100.0, 48000.0}) {
        const WaveformResampler resampler(rate);
        EXPECT_EQ(resampler.inputNeeded(static_cast<std::size_t>(rate) * 86400U), 172800000U) << rate;
    }
}

TEST(ResamplerPhaseTest, AfterAResetTheResamplerBehavesLikeANewOne) {
    const std::vector<float> input = whiteNoise(100, 1.0, 23);
    WaveformResampler fresh(44100.0);
    WaveformResampler used(44100.0);
    std::vector<float> expected(1000);
    std::vector<float> output(1000);
    used.process(std::span(input).last(used.inputNeeded(777)), std::span(output).first(777));
    used.reset();
    fresh.process(std::span(input).first(fresh.inputNeeded(1000)), expected);
    used.process(std::span(input).first(used.inputNeeded(1000)), output);
    EXPECT_EQ(output, expected);
}

TEST(ResamplerPhaseTest, MissingInputCountsAsSilence) {
    const std::vector<float> input = whiteNoise(100, 1.0, 24);
    WaveformResampler padded(48000.0);
    WaveformResampler shorted(48000.0);
    std::vector<float> some(input.begin(), input.begin() + 30);
    std::vector<float> filled = some;
    filled.resize(padded.inputNeeded(2000), 0.0F);
    std::vector<float> expected(2000);
    std::vector<float> output(2000);
    padded.process(filled, expected);
    shorted.process(some, output);
    EXPECT_EQ(output, expected);
}

TEST(ResamplerPhaseTest, UnsupportedRatesAreRejectedWithTheRangeInTheMessage) {
    for (const double rate : {0.0, -48000.0, 7999.0, 192001.0, std::numeric_limits<double>::quiet_NaN(),
                              std::numeric_limits<double>::infinity()}) {
        EXPECT_THROW(WaveformResampler{rate}, std::invalid_argument) << rate;
    }

    try {
        WaveformResampler resampler(7000.0);
        FAIL() << "7 kHz was accepted";
    } catch (const std::invalid_argument& error) {
        EXPECT_NE(std::string(error.what()).find("8000"), std::string::npos) << error.what();
    }
}

using testing::decibels;
using testing::lineSpectrum;
using testing::wholeHertzNoise;

constexpr std::size_t inputRateHz = 2000;

std::vector<float> resample(const std::vector<float>& input, double outputRateHz, std::size_t outputCount) {
    WaveformResampler resampler(outputRateHz);
    EXPECT_LE(resampler.inputNeeded(outputCount), input.size());
    std::vector<float> output(outputCount);
    resampler.process(std::span(input).first(resampler.inputNeeded(outputCount)), output);
    return output;
}

std::complex<double> kernelPhase(double frequencyHz) {
    constexpr int pointsPerSample = 64;
    std::complex<double> sum = 0.0;
    for (std::size_t i = 0; i < MinimumPhaseKernel::lengthInputSamples * pointsPerSample; ++i) {
        const double t = static_cast<double>(i) / pointsPerSample;
        const double cycles = frequencyHz / static_cast<double>(inputRateHz) * t;
        sum += std::polar(MinimumPhaseKernel::shared().at(t), -2.0 * std::numbers::pi * cycles);
    }
    return sum / std::abs(sum);
}

double largestImage(const std::vector<std::complex<double>>& lines) {
    const auto largest = std::max_element(lines.begin() + 1100, lines.end(),
                                          [](const auto& a, const auto& b) { return std::abs(a) < std::abs(b); });
    return std::abs(*largest);
}

class ResamplerSpectrumTest : public ::testing::TestWithParam<std::size_t> {};

TEST_P(ResamplerSpectrumTest, EveryLineIsThatOfTheInputAndImagesLieBelowMinus80DecibelsAfterPhaseCorrection) {
    const std::size_t rate = GetParam();
    const std::vector<float> input = wholeHertzNoise(5, 1, 999, inputRateHz, 12);
    const auto ours = lineSpectrum(resample(input, static_cast<double>(rate), 3 * rate), 2 * rate, rate);
    // A perfect resampler keeps the lines of noise with a period of one second.
    const auto reference = lineSpectrum(input, 2 * inputRateHz, inputRateHz);

    double worst = 0.0;
    for (std::size_t k = 1; k <= 900; ++k) {
        worst = std::max(worst, std::abs(ours[k] - reference[k] * kernelPhase(static_cast<double>(k))));
        EXPECT_NEAR(decibels(std::abs(ours[k])), 0.0, 0.05) << k << " Hz";
    }
    EXPECT_LT(decibels(worst), -80.0);
    EXPECT_LT(decibels(largestImage(ours)), -80.0);
}

INSTANTIATE_TEST_SUITE_P(Rates, ResamplerSpectrumTest,
                         ::testing::Values(8000, 11025, 16000, 22050, 24000, 44100, 48000, 96000, 192000),
                         [](const auto& rate) { return std::to_string(rate.param) + "Hz"; });

TEST(ResamplerSpectrumTest, ImagesStayBelowMinus80DecibelsAtARateWithMorePhasesThanTheTable) {
    constexpr std::size_t rate = 35721;  // shares no factor with 2,000: 35,721 distinct phases
    const std::vector<float> input = wholeHertzNoise(3, 1, 999, inputRateHz, 13);
    const auto lines = lineSpectrum(resample(input, rate, 2 * rate), rate, rate);
    EXPECT_LT(decibels(largestImage(lines)), -80.0);
    for (std::size_t k = 1; k <= 900; ++k) {
        ASSERT_NEAR(decibels(std::abs(lines[k])), 0.0, 0.05) << k << " Hz";
    }
}

TEST(ResamplerSpectrumTest, TheReportedGroupDelayMatchesTheDelayOfATonePacket) {
    const WaveformResampler resampler(48000.0);
    for (const double frequency : {160.0, 320.0, 640.0}) {
        std::vector<float> packet(800);
        for (std::size_t i = 0; i < packet.size(); ++i) {
            const double t = static_cast<double>(i) - 400.0;
            packet[i] = static_cast<float>(std::exp(-0.5 * t * t / (60.0 * 60.0)) *
                                           std::cos(2.0 * std::numbers::pi * frequency * t / 2000.0));
        }
        const std::vector<float> output = resample(packet, 48000.0, 19000);
        double moment = 0.0;
        double energy = 0.0;
        for (std::size_t i = 0; i < output.size(); ++i) {
            const double square = static_cast<double>(output[i]) * static_cast<double>(output[i]);
            moment += square * static_cast<double>(i) / 48000.0;
            energy += square;
        }
        EXPECT_NEAR(moment / energy - 400.0 / 2000.0, resampler.groupDelaySeconds(frequency), 5e-5) << frequency;
    }
    EXPECT_EQ(resampler.latencyInputSamples(), 2U);
    EXPECT_LT(resampler.groupDelaySeconds(200.0), 0.0013);
    EXPECT_LT(resampler.groupDelaySeconds(500.0), 0.0016);
    EXPECT_LT(resampler.groupDelaySeconds(900.0), 0.0042);
}

}  // namespace
}  // namespace haptoflow::dsp
