#include "effects/wave_features.hpp"
#include "effects/perceived_intensity.hpp"

#include "effects/feature_signals.hpp"
#include "support/counting_new.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <vector>

namespace haptoflow::effects {
namespace {

using testing::decayingSinusoidFrom;
using testing::featureNoise;
using testing::featureSine;
using testing::textureNoise;

constexpr float notANumber = std::numeric_limits<float>::quiet_NaN();

std::vector<WaveFrame> allFrames(WaveFeatures& features, const std::vector<float>& wave, std::size_t block) {
    std::vector<WaveFrame> frames;
    std::vector<WaveFrame> room(features.framesWithin(block));
    for (std::size_t i = 0; i < wave.size(); i += block) {
        const std::size_t count = std::min(block, wave.size() - i);
        const WaveFeatures::Progress progress = features.process(std::span(wave).subspan(i, count), room);
        EXPECT_EQ(progress.samples, count) << "framesWithin was too small";
        frames.insert(frames.end(), room.begin(), room.begin() + static_cast<std::ptrdiff_t>(progress.frames));
    }
    return frames;
}

/// Frames of a wave without its first and last 64 ms.
std::vector<WaveFrame> steadyFrames(const std::vector<float>& wave, const WaveFeatureOptions& options) {
    WaveFeatures features(options);
    std::vector<WaveFrame> frames = allFrames(features, wave, 28);
    std::erase_if(frames, [&](const WaveFrame& frame) {
        return frame.firstSample < 256 || frame.firstSample + 128 > wave.size();
    });
    return frames;
}

std::vector<WaveTransient> transientsOf(const std::vector<float>& wave, const WaveFeatureOptions& options = {},
                                        std::vector<double>* seconds = nullptr) {
    WaveFeatures features(options);
    std::vector<WaveTransient> transients;
    for (const WaveFrame& frame : allFrames(features, wave, 28)) {
        if (frame.transient.amplitudeMps2 > 0.0F) {
            transients.push_back(frame.transient);
            if (seconds != nullptr) {
                seconds->push_back(static_cast<double>(frame.firstSample) / WaveFeatures::sampleRateHz +
                                   static_cast<double>(frame.transient.offsetSeconds));
            }
        }
    }
    return transients;
}

void expectEqual(const std::vector<WaveFrame>& frames, const std::vector<WaveFrame>& expected) {
    ASSERT_EQ(frames.size(), expected.size());
    for (std::size_t i = 0; i < frames.size(); ++i) {
        ASSERT_EQ(frames[i].firstSample, expected[i].firstSample);
        ASSERT_EQ(frames[i].intensity, expected[i].intensity);
        ASSERT_EQ(frames[i].amplitudeMps2, expected[i].amplitudeMps2);
        ASSERT_EQ(frames[i].frequencyHz, expected[i].frequencyHz);
        ASSERT_EQ(frames[i].transient.amplitudeMps2, expected[i].transient.amplitudeMps2);
        ASSERT_EQ(frames[i].transient.offsetSeconds, expected[i].transient.offsetSeconds);
    }
}

double decibelsBetween(double value, double reference) {
    return 20.0 * std::log10(value / reference);
}

TEST(ThresholdFilterTest, TheFilterWeightsEachFrequencyByTheInverseOfItsThreshold) {
    for (double frequencyHz = 30.0; frequencyHz <= 400.0; frequencyHz += 5.0) {
        std::complex<double> sum = 0.0;
        for (std::size_t i = 0; i < ThresholdFilter::taps; ++i) {
            sum += ThresholdFilter::shared().impulseResponse()[i] *
                   std::polar(1.0, -2.0 * std::numbers::pi * frequencyHz / 2000.0 * static_cast<double>(i));
        }
        EXPECT_NEAR(20.0 * std::log10(std::abs(sum) * detectionThresholdMps2(frequencyHz)), 0.0, 0.1) << frequencyHz;
    }
    EXPECT_LT(ThresholdFilter::shared().delaySamples(), static_cast<double>(WaveFeatures::lookaheadSamples));
}

TEST(WaveFeaturesTest, ASinusoidHasTheIntensityAndTheCarrierOfItsOwnFrequencyAndAmplitude) {
    for (const double frameSeconds : {0.004, 0.005, 0.008, 1.0 / 72.0}) {
        for (const double frequencyHz : {40.0, 55.0, 63.0, 80.0, 110.0, 125.0, 160.0, 200.0, 250.0, 320.0, 400.0}) {
            for (const double amplitude : {0.3, 5.0, 120.0}) {
                WaveFeatureOptions options;
                options.frameSeconds = frameSeconds;
                options.minFrequencyHz = 30.0;
                const double intensity = intensityOfSinusoid(amplitude, frequencyHz);
                if (intensity < 1.0) {
                    continue;
                }
                for (const WaveFrame& frame : steadyFrames(featureSine(frequencyHz, amplitude, 1.0), options)) {
                    ASSERT_NEAR(decibelsBetween(static_cast<double>(frame.intensity), intensity), 0.0, 1.1)
                        << frequencyHz << " Hz, " << amplitude << " m/s^2, sample " << frame.firstSample;
                    // Less than a hand notices; the window spreads low frequencies downwards.
                    ASSERT_NEAR(static_cast<double>(frame.centroidHz), frequencyHz, frequencyHz / 7.0);
                    ASSERT_NEAR(decibelsBetween(static_cast<double>(frame.amplitudeMps2), amplitude), 0.0, 2.2)
                        << frequencyHz << " Hz, " << amplitude << " m/s^2, sample " << frame.firstSample;
                }
            }
        }
    }
}

TEST(WaveFeaturesTest, AMotorWithOneFrequencyGetsTheAmplitudeOfEqualIntensity) {
    WaveFeatureOptions options;
    options.minFrequencyHz = 160.0;
    options.maxFrequencyHz = 160.0;
    for (const double frequencyHz : {40.0, 80.0, 250.0, 400.0}) {
        const double wanted = amplitudeOfIntensity(intensityOfSinusoid(5.0, frequencyHz), 160.0);
        for (const WaveFrame& frame : steadyFrames(featureSine(frequencyHz, 5.0, 1.0), options)) {
            ASSERT_EQ(frame.frequencyHz, 160.0F);
            ASSERT_NEAR(decibelsBetween(static_cast<double>(frame.amplitudeMps2), wanted), 0.0, 1.1) << frequencyHz;
        }
    }
}

/// [N]: the sum of two waves of one length.
std::vector<float> sumOf(std::vector<float> wave, const std::vector<float>& other) {
    std::ranges::transform(wave, other, wave.begin(), std::plus());
    return wave;
}

double medianCarrierHz(const std::vector<float>& wave, const WaveFeatureOptions& options = {}) {
    std::vector<WaveFrame> frames = steadyFrames(wave, options);
    std::ranges::sort(frames, {}, &WaveFrame::frequencyHz);
    return static_cast<double>(frames[frames.size() / 2].frequencyHz);
}

TEST(WaveFeaturesTest, WhatLiesBelowTheThresholdDoesNotMoveTheCarrier) {
    const std::vector<float> felt = featureSine(80.0, 0.6, 1.0);
    const std::vector<float> below = featureSine(400.0, 0.9 * detectionThresholdMps2(400.0), 1.0);
    EXPECT_NEAR(medianCarrierHz(sumOf(felt, below)), medianCarrierHz(felt), 2.0);
}

TEST(WaveFeaturesTest, ANarrowDeviceKeepsTheOrderOfTextures) {
    WaveFeatureOptions options;
    options.minFrequencyHz = 100.0;
    options.maxFrequencyHz = 200.0;
    double last = 100.0;
    for (const double frequencyHz : {60.0, 90.0, 120.0, 170.0, 220.0}) {
        const double carrier = medianCarrierHz(featureSine(frequencyHz, 5.0, 0.5), options);
        EXPECT_GT(carrier, 1.03 * last) << frequencyHz;
        EXPECT_LT(carrier, 200.0) << frequencyHz;
        last = carrier;
    }
    EXPECT_EQ(medianCarrierHz(featureSine(320.0, 5.0, 0.5), options), 200.0);
}

TEST(WaveFeaturesTest, ASteadyTextureHasASteadyAmplitudeAndFrequency) {
    std::vector<double> amplitudeSteps;
    std::vector<double> frequencySteps;
    const std::vector<WaveFrame> frames = steadyFrames(textureNoise(5.0, 20.0, 1), {});
    for (std::size_t i = 1; i < frames.size(); ++i) {
        const auto step = [&](float WaveFrame::*member) {
            return std::abs(
                decibelsBetween(static_cast<double>(frames[i].*member), static_cast<double>(frames[i - 1].*member)));
        };
        amplitudeSteps.push_back(step(&WaveFrame::amplitudeMps2));
        frequencySteps.push_back(step(&WaveFrame::frequencyHz));
    }
    std::ranges::sort(amplitudeSteps);
    std::ranges::sort(frequencySteps);
    const std::size_t rank = 95 * amplitudeSteps.size() / 100;
    EXPECT_LT(amplitudeSteps[rank], 3.5);
    EXPECT_LT(frequencySteps[rank], 1.0) << "an eighth, half of what a hand notices";
}

TEST(WaveFeaturesTest, ATapOnATextureArrivesInItsOwnFrameAtFullHeight) {
    for (const double frequencyHz : {80.0, 150.0, 250.0}) {
        for (std::size_t start = 2000; start < 2010; ++start) {
            const std::vector<float> tap = decayingSinusoidFrom(start, frequencyHz, 40.0, 80.0, 1.5);
            WaveFeatures alone;
            WaveFeatures onTexture;
            const std::vector<WaveFrame> wanted = allFrames(alone, tap, 28);
            const std::vector<WaveFrame> frames = allFrames(onTexture, sumOf(tap, textureNoise(1.0, 2.0, 3)), 28);
            const auto strongest = std::ranges::max_element(wanted, {}, &WaveFrame::intensity);
            const auto& own = frames[static_cast<std::size_t>(strongest - wanted.begin())];
            EXPECT_NEAR(decibelsBetween(static_cast<double>(own.intensity), static_cast<double>(strongest->intensity)),
                        0.0, 5.0)
                << "the texture adds or takes away at most that; " << frequencyHz << " Hz, " << start;
        }
    }
}

TEST(WaveFeaturesTest, ModulationThatAHandCanCountIsLeft) {
    std::vector<float> wave = textureNoise(5.0, 20.0, 6);
    constexpr double modulationHz = 5.0;
    const auto turnsAt = [](double sample) { return 2.0 * std::numbers::pi * modulationHz * sample / 2000.0; };
    for (std::size_t i = 0; i < wave.size(); ++i) {
        wave[i] *= static_cast<float>(1.0 + 0.8 * std::sin(turnsAt(static_cast<double>(i))));
    }
    double mean = 0.0;
    std::complex<double> swing = 0.0;
    for (const WaveFrame& frame : steadyFrames(wave, {})) {
        mean += static_cast<double>(frame.amplitudeMps2);
        swing += static_cast<double>(frame.amplitudeMps2) *
                 std::polar(1.0, -turnsAt(static_cast<double>(frame.firstSample) + 5.0));
    }
    EXPECT_GT(2.0 * std::abs(swing) / mean, 0.8 * 0.8);
}

TEST(WaveFeaturesTest, TheBlockLengthsDoNotChangeTheFrames) {
    std::vector<float> wave = featureNoise(5.0, 2.0, 1);
    for (std::size_t i = 1000; i < 1200; ++i) {
        wave[i] *= 30.0F;
    }
    WaveFeatures whole;
    const std::vector<WaveFrame> expected = allFrames(whole, wave, wave.size());
    for (const std::size_t block : {1U, 3U, 10U, 28U, 27U, 977U}) {
        WaveFeatures features;
        SCOPED_TRACE(block);
        expectEqual(allFrames(features, wave, block), expected);
    }
}

TEST(WaveFeaturesTest, FramesOfAFractionalLengthCoverTheWaveWithoutGaps) {
    for (const double frameSeconds : {0.002, 0.0053, 1.0 / 72.0, 1.0 / 90.0, 0.032}) {
        WaveFeatureOptions options;
        options.frameSeconds = frameSeconds;
        WaveFeatures features(options);
        const std::vector<WaveFrame> frames = allFrames(features, std::vector<float>(40000, 0.0F), 28);
        std::uint64_t next = 0;
        for (const WaveFrame& frame : frames) {
            ASSERT_EQ(frame.firstSample, next);
            next += frame.sampleCount;
        }
        EXPECT_NEAR(static_cast<double>(frames.size()), 40000.0 / (2000.0 * frameSeconds), 6.0) << frameSeconds;
    }
}

TEST(WaveFeaturesTest, AFrameIsReadyTheDeclaredLatencyAfterItsEnd) {
    WaveFeatureOptions options;
    options.frameSeconds = 0.005;
    WaveFeatures features(options);
    std::vector<WaveFrame> frames(4);
    const std::vector<float> wave(100, 1.0F);
    const std::size_t ready = 10 + WaveFeatures::lookaheadSamples;
    EXPECT_EQ(features.process(std::span(wave).first(ready - 1), frames).frames, 0U);
    EXPECT_EQ(features.process(std::span(wave).first(1), frames).frames, 1U);
    EXPECT_DOUBLE_EQ(WaveFeatures::latencySeconds, 0.004);
}

TEST(WaveFeaturesTest, NoSampleIsLostIfAFrameDoesNotFit) {
    const std::vector<float> wave = featureNoise(5.0, 1.0, 2);
    WaveFeatures roomy;
    const std::vector<WaveFrame> expected = allFrames(roomy, wave, wave.size());
    WaveFeatures narrow;
    std::vector<WaveFrame> frames;
    std::vector<WaveFrame> one(1);
    for (std::size_t at = 0; at < wave.size();) {
        const WaveFeatures::Progress progress = narrow.process(std::span(wave).subspan(at), one);
        at += progress.samples;
        if (progress.frames == 1) {
            frames.push_back(one[0]);
        }
    }
    EXPECT_EQ(narrow.process({}, {}).samples, 0U);
    while (narrow.process({}, one).frames == 1) {
        frames.push_back(one[0]);
    }
    expectEqual(frames, expected);
}

TEST(WaveFeaturesTest, AnOnsetIsFoundOnceAndWithinAMillisecondWhereverItFallsInAFrame) {
    for (const double frequencyHz : {80.0, 150.0, 250.0, 350.0}) {
        for (std::size_t start = 400; start < 440; ++start) {
            std::vector<double> seconds;
            const std::vector<float> wave = decayingSinusoidFrom(start, frequencyHz, 60.0, 60.0, 0.5);
            const std::vector<WaveTransient> transients = transientsOf(wave, {}, &seconds);
            ASSERT_EQ(transients.size(), 1U) << frequencyHz << " Hz from sample " << start;
            EXPECT_NEAR(seconds[0], static_cast<double>(start) / 2000.0, 0.00105) << frequencyHz << " Hz, " << start;
            EXPECT_GE(transients[0].offsetSeconds, 0.0F);
            EXPECT_LE(transients[0].offsetSeconds, 0.005F);
            EXPECT_NEAR(static_cast<double>(transients[0].frequencyHz), frequencyHz, 0.4 * frequencyHz);
            const double peak =
                static_cast<double>(*std::ranges::max_element(wave, {}, [](float sample) { return std::abs(sample); }));
            const double played = intensityOfSinusoid(static_cast<double>(transients[0].amplitudeMps2),
                                                      static_cast<double>(transients[0].frequencyHz));
            const double wanted = intensityOfSinusoid(std::abs(peak), frequencyHz);
            EXPECT_NEAR(decibelsBetween(played, wanted), 0.0, 7.0) << frequencyHz;
        }
    }
}

TEST(WaveFeaturesTest, OnsetsKeepTheRefractoryTimeApart) {
    std::vector<float> wave(4000, 0.0F);
    for (std::size_t start = 200; start < 3800; start += 160) {
        wave = sumOf(wave, decayingSinusoidFrom(start, 250.0, 40.0, 900.0, 2.0));
    }
    EXPECT_EQ(transientsOf(wave).size(), 23U) << "80 ms apart";
    // Each tap is twenty times as strong as the one before; the second comes 20 ms after the first.
    std::vector<float> growing(1000, 0.0F);
    for (const auto& [start, amplitude] : {std::pair{200U, 2.0}, {240U, 40.0}, {340U, 800.0}}) {
        growing = sumOf(growing, decayingSinusoidFrom(start, 250.0, amplitude, 900.0, 0.5));
    }
    std::vector<double> seconds;
    transientsOf(growing, {}, &seconds);
    ASSERT_EQ(seconds.size(), 2U);
    EXPECT_NEAR(seconds[0], 0.1, 0.002);
    EXPECT_NEAR(seconds[1], 0.17, 0.002);
}

TEST(WaveFeaturesTest, SilenceHasNoIntensityAndKeepsTheLastFrequency) {
    std::vector<float> wave = featureSine(250.0, 5.0, 0.5);
    wave.resize(3000, 0.0F);
    WaveFeatures features;
    const std::vector<WaveFrame> frames = allFrames(features, wave, 28);
    EXPECT_EQ(frames.back().intensity, 0.0F);
    EXPECT_EQ(frames.back().amplitudeMps2, 0.0F);
    EXPECT_GT(frames.back().frequencyHz, 150.0F);
}

TEST(WaveFeaturesTest, AnOffsetAndSlowMovementAreNotFelt) {
    WaveFeatureOptions options;
    std::vector<float> wave(4000, 0.5F);
    for (const WaveFrame& frame : steadyFrames(wave, options)) {
        ASSERT_LT(frame.intensity, 1.0F);
    }
}

TEST(WaveFeaturesTest, ANewDeviceRangeAppliesFromTheNextFrameOn) {
    WaveFeatures features;
    std::vector<WaveFrame> frames(400);
    const std::vector<float> wave = featureSine(300.0, 5.0, 0.5);
    EXPECT_EQ(features.process(wave, frames).samples, wave.size());
    features.setDeviceRange(100.0, 200.0);
    ASSERT_GE(features.process(wave, frames).frames, 1U);
    EXPECT_EQ(frames[0].frequencyHz, 200.0F);
    for (const auto& [low, high] : {std::pair{0.0, 100.0}, {300.0, 200.0}, {std::nan(""), 300.0}, {100.0, 5000.0}}) {
        features.setDeviceRange(low, high);
        ASSERT_GE(features.process(wave, frames).frames, 1U);
        EXPECT_EQ(frames[0].frequencyHz, 200.0F) << low << " to " << high;
    }
}

TEST(WaveFeaturesTest, AResetClearsTheHistory) {
    WaveFeatures used;
    std::vector<WaveFrame> before(2000);
    static_cast<void>(used.process(featureNoise(50.0, 3.0, 5), before));
    used.reset();
    WaveFeatures fresh;
    const std::vector<float> wave = featureSine(120.0, 3.0, 0.3);
    expectEqual(allFrames(used, wave, 28), allFrames(fresh, wave, 28));
}

TEST(WaveFeaturesTest, NonFiniteSamplesCountAsZeroAndTheFramesAreFinite) {
    std::vector<float> wave = featureNoise(5.0, 1.0, 6);
    std::vector<float> zeros = wave;
    for (const std::size_t at : {3U, 500U, 501U, 900U}) {
        wave[at] = at == 500 ? std::numeric_limits<float>::infinity() : notANumber;
        zeros[at] = 0.0F;
    }
    WaveFeatures features;
    WaveFeatures reference;
    expectEqual(allFrames(features, wave, 28), allFrames(reference, zeros, 28));
    WaveFeatures shaken;
    for (const WaveFrame& frame : allFrames(shaken, std::vector<float>(2000, std::numeric_limits<float>::max()), 28)) {
        ASSERT_TRUE(std::isfinite(frame.intensity));
        ASSERT_TRUE(std::isfinite(frame.amplitudeMps2));
        ASSERT_TRUE(std::isfinite(frame.transient.amplitudeMps2));
    }
}

TEST(WaveFeaturesTest, OptionsOutOfRangeAreRejected) {
    const auto refused = [](auto change) {
        WaveFeatureOptions options;
        change(options);
        EXPECT_FALSE(options.isValid());
        EXPECT_THROW(WaveFeatures{options}, std::invalid_argument);
    };
    refused([](WaveFeatureOptions& options) { options.frameSeconds = 0.0; });
    refused([](WaveFeatureOptions& options) { options.frameSeconds = 0.05; });
    refused([](WaveFeatureOptions& options) { options.frameSeconds = std::nan(""); });
    refused([](WaveFeatureOptions& options) { options.minFrequencyHz = 0.0; });
    refused([](WaveFeatureOptions& options) { options.minFrequencyHz = 500.0; });
    refused([](WaveFeatureOptions& options) { options.maxFrequencyHz = 1001.0; });
}

TEST(WaveFeaturesTest, ProcessAllocatesNothing) {
    WaveFeatures features;
    const std::vector<float> wave = featureNoise(20.0, 1.0, 7);
    std::vector<WaveFrame> frames(features.framesWithin(wave.size()));
    const std::size_t before = haptoflow::testing::allocationCount();
    for (int i = 0; i < 10; ++i) {
        static_cast<void>(features.process(wave, frames));
        features.setDeviceRange(100.0, 300.0);
    }
    features.reset();
    EXPECT_EQ(haptoflow::testing::allocationCount(), before);
}

}  // namespace
}  // namespace haptoflow::effects
