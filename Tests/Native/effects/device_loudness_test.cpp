#include "effects/device_loudness.hpp"

#include "support/wave_measures.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <numeric>
#include <span>
#include <stdexcept>
#include <vector>

namespace haptoflow::effects {
namespace {

constexpr std::array everyDeviceKind{DeviceKind::motor, DeviceKind::parametric, DeviceKind::waveform};
using haptoflow::testing::peak;
using haptoflow::testing::sine;

constexpr double deviceRateHz[] = {2000.0, 8000.0, 11025.0, 44100.0, 48000.0, 192000.0};

TEST(DeviceLoudnessTest, EveryLargerAmplitudeIsPlayedStrongerAndNoneReachesTheEndOfTheRange) {
    for (const DeviceKind kind : everyDeviceKind) {
        float before = 0.0F;
        for (double mps2 = 1e-4; mps2 < 400.0; mps2 *= 1.02) {
            const float share = deviceShare(kind, static_cast<float>(mps2));
            EXPECT_GT(share, before) << mps2;
            EXPECT_LT(share, 1.0F) << mps2;
            before = share;
        }
    }
}

TEST(DeviceLoudnessTest, TheThresholdIsPlayedWhereAMotorBeginsToMove) {
    for (const DeviceKind kind : everyDeviceKind) {
        EXPECT_NEAR(deviceShare(kind, 0.03F), 0.06F, 0.02F);
    }
}

TEST(DeviceWaveTest, ASteadySineIsPlayedAtTheShareOfItsPeakAndStaysASine) {
    for (const double rateHz : deviceRateHz) {
        for (const double frequencyHz : {60.0, 160.0, 400.0}) {
            for (const double mps2 : {0.1, 2.0, 40.0}) {
                EnvelopeGain device = deviceWave(rateHz);
                std::vector<float> wave = sine(frequencyHz, mps2, 0.4, rateHz);
                const std::vector<float> given = wave;
                device.process(wave);
                const auto settled = std::span(wave).last(wave.size() / 2);
                const float share = deviceShare(DeviceKind::waveform, static_cast<float>(mps2));
                EXPECT_NEAR(peak(settled), share, 0.06F * share) << rateHz << " Hz, " << frequencyHz << " Hz " << mps2;
                // Fits the delayed input by one factor: what is left is distortion.
                const std::size_t step = static_cast<std::size_t>(std::ceil(rateHz / 2000.0));
                const auto delayed = std::span(given).subspan(wave.size() / 2 - 2 * step, settled.size());
                const auto product = [](std::span<const float> one, std::span<const float> other) {
                    return std::inner_product(one.begin(), one.end(), other.begin(), 0.0);
                };
                const double played = product(settled, settled);
                const double left = played - std::pow(product(delayed, settled), 2.0) / product(delayed, delayed);
                EXPECT_LT(std::sqrt(std::max(0.0, left) / played), 0.03) << rateHz << ' ' << frequencyHz << ' ' << mps2;
            }
        }
    }
}

TEST(DeviceWaveTest, AnImpactOutOfSilenceKeepsItsAttackAndDoesNotOvershoot) {
    constexpr double rateHz = 8000.0;
    EnvelopeGain device = deviceWave(rateHz);
    std::vector<float> wave(800, 0.0F);
    for (std::size_t i = 400; i < wave.size(); ++i) {
        const double seconds = static_cast<double>(i - 400) / rateHz;
        wave[i] = static_cast<float>(80.0 * std::exp(-60.0 * seconds) *
                                     std::sin(2.0 * std::numbers::pi * 300.0 * seconds + 1.2));
    }
    device.process(wave);
    // A millisecond later, to the sample.
    EXPECT_EQ(peak(std::span(wave).first(408)), 0.0F);
    EXPECT_GT(std::abs(wave[408]), 0.5F);
    EXPECT_LT(peak(wave), deviceShare(DeviceKind::waveform, 80.0F) * 1.001F);
}

TEST(DeviceWaveTest, AnyInputGivesFiniteSamplesWithinTheRange) {
    EnvelopeGain device = deviceWave(8000.0);
    std::vector<float> wave(4000, 0.5F);
    wave[10] = std::nanf("");
    wave[400] = INFINITY;
    wave[900] = -std::numeric_limits<float>::max();
    wave[1500] = 1e-42F;
    device.process(wave);
    for (const float sample : wave) {
        ASSERT_TRUE(std::isfinite(sample) && std::abs(sample) <= 1.0F) << sample;
    }
}

TEST(DeviceWaveTest, ARateOutOfRangeIsRefused) {
    for (const double rateHz : {0.0, 1999.0, 192001.0, std::numeric_limits<double>::quiet_NaN()}) {
        EXPECT_THROW((void)deviceWave(rateHz), std::invalid_argument) << rateHz;
    }
}

constexpr double listenRateHz[] = {8000.0, 11025.0, 44100.0, 48000.0, 192000.0};
constexpr double listenFullScaleMps2 = 200.0;

/// The second half of what is heard of a wave.
std::vector<float> heard(double rateHz, std::vector<float> wave) {
    Listen listen(rateHz, listenFullScaleMps2);
    listen.reset();
    listen.process(wave);
    return {wave.begin() + static_cast<std::ptrdiff_t>(wave.size() / 2), wave.end()};
}

TEST(ListenTest, AQuietTextureBecomesAudibleAndAStrongOneStaysBelowFullScale) {
    for (const double rateHz : listenRateHz) {
        EXPECT_GT(peak(heard(rateHz, sine(300.0, 1.0, 0.4, rateHz))), 0.1 * listenFullScaleMps2) << rateHz;
        EXPECT_LT(peak(heard(rateHz, sine(300.0, 150.0, 0.4, rateHz))), 0.91 * listenFullScaleMps2) << rateHz;
    }
}

TEST(ListenTest, AHighToneGainsMoreThanALowOneInTheSameSound) {
    for (const double rateHz : listenRateHz) {
        std::vector<float> wave = sine(100.0, 1.0, 0.5, rateHz);
        std::ranges::transform(wave, sine(600.0, 1.0, 0.5, rateHz), wave.begin(), std::plus());
        const std::vector<float> sound = heard(rateHz, wave);
        const auto amplitudeAt = [&](double hz) { return haptoflow::testing::amplitudeAt(sound, hz, rateHz); };
        EXPECT_GT(20.0 * std::log10(amplitudeAt(600.0) / amplitudeAt(100.0)), 15.0) << rateHz;
    }
}

TEST(ListenTest, AfterItsTailItIsIdleAndSilent) {
    Listen listen(48000.0, listenFullScaleMps2);
    EXPECT_TRUE(listen.isIdle());
    std::vector<float> wave(4800, 5.0F);
    listen.process(wave);
    EXPECT_FALSE(listen.isIdle());
    std::vector<float> silence(static_cast<std::size_t>(48000.0 * 0.02), 0.0F);
    listen.process(silence);
    EXPECT_TRUE(listen.isIdle());
    std::ranges::fill(silence, 0.0F);
    listen.process(silence);
    EXPECT_EQ(peak(silence), 0.0F);
}

TEST(ListenTest, AFullScaleOutOfRangeIsRefused) {
    for (const double scale : {0.0, -1.0, std::numeric_limits<double>::infinity()}) {
        EXPECT_THROW(Listen(48000.0, scale), std::invalid_argument) << scale;
    }
}

}  // namespace
}  // namespace haptoflow::effects
