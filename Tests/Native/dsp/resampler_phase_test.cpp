#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "dsp/waveform_resampler.hpp"
#include "test_signals.hpp"

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

}  // namespace
}  // namespace haptoflow::dsp
