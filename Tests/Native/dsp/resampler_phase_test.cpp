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

TEST(ResamplerPhaseTest, AnInputSampleIsConsumedWhenTheReadPositionReachesIt) {
    for (const double rate : everyOutputRate) {
        WaveformResampler resampler(rate);
        std::size_t consumed = 0;
        float sample = 0.0F;
        for (std::size_t n = 0; n < 5000; ++n) {
            const std::size_t needed = resampler.inputNeeded(1);
            const double until = resampler.samplesUntilNext();
            ASSERT_GE(until, 0.0);
            if (n > 0) {
                // The waveform's time of this output: what was consumed before, less what is left until the next.
                ASSERT_NEAR(static_cast<double>(consumed) - until, static_cast<double>(n) * 2000.0 / rate,
                            needed > 0 ? 2000.0 / rate : 1e-6)
                    << "output " << n << " at " << rate << " Hz";
            }
            const float zero[1] = {0.0F};
            resampler.process(std::span(zero).first(needed), std::span(&sample, 1));
            consumed += needed;
            const auto position = static_cast<long double>(n) * 2000.0L / static_cast<long double>(rate);
            ASSERT_NEAR(static_cast<double>(static_cast<long double>(consumed) - 1.0L - std::floor(position)), 0.0, 0.0)
                << "output " << n << " at " << rate << " Hz";
        }
    }
}

TEST(ResamplerPhaseTest, ADayOfOutputConsumesExactlyADayOfInput) {
    for (const double rate : {8000.0, 11025.0, 22050.0, 44100.0, 48000.0}) {
        const WaveformResampler resampler(rate);
        EXPECT_EQ(resampler.inputNeeded(static_cast<std::size_t>(rate) * 86400U), 172800000U) << rate;
    }
}

TEST(ResamplerPhaseTest, TenMinutesInBlocksReachTheSamePhaseAsOneCall) {
    // 11,025 Hz has the longest phase cycle of the common rates; 12,345.678 Hz interpolates between phases.
    for (const double rate : {11025.0, 12345.678}) {
        WaveformResampler resampler(rate);
        const std::vector<float> silence(200, 0.0F);
        std::vector<float> block(512);
        std::size_t produced = 0;
        std::size_t consumed = 0;
        const auto tenMinutes = static_cast<std::size_t>(rate * 600.0);
        while (produced < tenMinutes) {
            const std::size_t needed = resampler.inputNeeded(block.size());
            resampler.process(std::span(silence).first(needed), block);
            produced += block.size();
            consumed += needed;
        }
        EXPECT_EQ(consumed, WaveformResampler(rate).inputNeeded(produced)) << rate;
        // Compared with real arithmetic, because rounding the rate to 2^-20 Hz shifts ten minutes by less than 1/1000
        // of a sample.
        const double position = static_cast<double>(produced - 1) * 2000.0 / rate;
        EXPECT_NEAR(static_cast<double>(consumed) - 0.5, position, 0.501) << rate;
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
