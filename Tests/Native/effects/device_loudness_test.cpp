#include "effects/device_loudness.hpp"

#include "effects/wave_features.hpp"
#include "support/counting_new.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <span>
#include <stdexcept>
#include <vector>

namespace haptoflow::effects {
namespace {

constexpr std::array everyDeviceKind{DeviceKind::motor, DeviceKind::parametric, DeviceKind::waveform};
constexpr double deviceRateHz[] = {2000.0, 8000.0, 11025.0, 44100.0, 48000.0, 192000.0};

std::vector<float> deviceSine(double frequencyHz, double mps2, double rateHz, double seconds) {
    std::vector<float> wave(static_cast<std::size_t>(seconds * rateHz));
    for (std::size_t i = 0; i < wave.size(); ++i) {
        wave[i] =
            static_cast<float>(mps2 * std::sin(2.0 * std::numbers::pi * frequencyHz * static_cast<double>(i) / rateHz));
    }
    return wave;
}

float devicePeak(std::span<const float> wave) {
    float largest = 0.0F;
    for (const float sample : wave) {
        largest = std::max(largest, std::abs(sample));
    }
    return largest;
}

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
                DeviceWave device(rateHz);
                std::vector<float> wave = deviceSine(frequencyHz, mps2, rateHz, 0.4);
                const std::vector<float> given = wave;
                device.process(wave);
                const auto settled = std::span(wave).last(wave.size() / 2);
                const float share = deviceShare(DeviceKind::waveform, static_cast<float>(mps2));
                EXPECT_NEAR(devicePeak(settled), share, 0.06F * share)
                    << rateHz << " Hz, " << frequencyHz << " Hz " << mps2;
                // Fits the delayed input by one factor: what is left is distortion.
                const std::size_t step = static_cast<std::size_t>(std::ceil(rateHz / 2000.0));
                double product = 0.0;
                double square = 0.0;
                double played = 0.0;
                for (std::size_t i = wave.size() / 2; i < wave.size(); ++i) {
                    const auto in = static_cast<double>(given[i - 2 * step]);
                    const auto out = static_cast<double>(wave[i]);
                    product += in * out;
                    square += in * in;
                    played += out * out;
                }
                const double left = played - product * product / square;
                EXPECT_LT(std::sqrt(std::max(0.0, left) / played), 0.03) << rateHz << ' ' << frequencyHz << ' ' << mps2;
            }
        }
    }
}

TEST(DeviceWaveTest, AnImpactOutOfSilenceKeepsItsAttackAndDoesNotOvershoot) {
    constexpr double rateHz = 8000.0;
    DeviceWave device(rateHz);
    std::vector<float> wave(800, 0.0F);
    for (std::size_t i = 400; i < wave.size(); ++i) {
        const double seconds = static_cast<double>(i - 400) / rateHz;
        wave[i] = static_cast<float>(80.0 * std::exp(-60.0 * seconds) *
                                     std::sin(2.0 * std::numbers::pi * 300.0 * seconds + 1.2));
    }
    device.process(wave);
    // A millisecond later, to the sample.
    EXPECT_EQ(devicePeak(std::span(wave).first(408)), 0.0F);
    EXPECT_GT(std::abs(wave[408]), 0.5F);
    EXPECT_LT(devicePeak(wave), deviceShare(DeviceKind::waveform, 80.0F) * 1.001F);
}

TEST(DeviceWaveTest, TheOutputDoesNotDependOnTheBlocks) {
    std::mt19937 random(5);
    std::normal_distribution<float> normal(0.0F, 6.0F);
    std::vector<float> whole(9000);
    std::ranges::generate(whole, [&] { return normal(random); });
    std::vector<float> cut = whole;
    DeviceWave one(8000.0);
    one.process(whole);
    DeviceWave two(8000.0);
    for (std::size_t at = 0, count = 1; at < cut.size(); at += count, count = 1 + (count * 7) % 301) {
        two.process(std::span(cut).subspan(at, std::min(count, cut.size() - at)));
    }
    EXPECT_EQ(whole, cut);
}

TEST(DeviceWaveTest, AnyInputGivesFiniteSamplesWithinTheRange) {
    DeviceWave device(8000.0);
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
        EXPECT_THROW(DeviceWave{rateHz}, std::invalid_argument) << rateHz;
    }
}

TEST(DeviceWaveTest, ProcessingAllocatesNothing) {
    DeviceWave device(48000.0);
    std::vector<float> wave(4800, 1.0F);
    const std::size_t before = haptoflow::testing::allocationCount();
    device.process(wave);
    device.reset();
    EXPECT_EQ(haptoflow::testing::allocationCount(), before);
}

constexpr double listenRateHz[] = {8000.0, 11025.0, 44100.0, 48000.0, 192000.0};
constexpr double listenFullScaleMps2 = 200.0;

std::vector<float> heard(double rateHz, double frequencyHz, double mps2) {
    std::vector<float> wave(static_cast<std::size_t>(0.4 * rateHz));
    for (std::size_t i = 0; i < wave.size(); ++i) {
        wave[i] =
            static_cast<float>(mps2 * std::sin(2.0 * std::numbers::pi * frequencyHz * static_cast<double>(i) / rateHz));
    }
    Listen listen(rateHz, listenFullScaleMps2);
    listen.reset();
    listen.process(wave);
    return wave;
}

double heardPeak(std::span<const float> wave) {
    double largest = 0.0;
    for (const float sample : wave.last(wave.size() / 2)) {
        largest = std::max(largest, std::abs(static_cast<double>(sample)));
    }
    return largest;
}

TEST(ListenTest, AQuietTextureBecomesAudibleAndAStrongOneStaysBelowFullScale) {
    for (const double rateHz : listenRateHz) {
        EXPECT_GT(heardPeak(heard(rateHz, 300.0, 1.0)), 0.1 * listenFullScaleMps2) << rateHz;
        EXPECT_LT(heardPeak(heard(rateHz, 300.0, 150.0)), 0.91 * listenFullScaleMps2) << rateHz;
    }
}

TEST(ListenTest, AHighToneGainsMoreThanALowOneInTheSameSound) {
    for (const double rateHz : listenRateHz) {
        std::vector<float> wave(static_cast<std::size_t>(0.5 * rateHz));
        const auto add = [&](std::vector<float>& to, double hz, double mps2) {
            for (std::size_t i = 0; i < to.size(); ++i) {
                to[i] +=
                    static_cast<float>(mps2 * std::sin(2.0 * std::numbers::pi * hz * static_cast<double>(i) / rateHz));
            }
        };
        add(wave, 100.0, 1.0);
        add(wave, 600.0, 1.0);
        Listen listen(rateHz, listenFullScaleMps2);
        listen.reset();
        listen.process(wave);
        const auto amplitudeAt = [&](double hz) {
            double real = 0.0;
            double imaginary = 0.0;
            const std::size_t count = wave.size() / 2;
            for (std::size_t i = count; i < wave.size(); ++i) {
                const double turn = 2.0 * std::numbers::pi * hz * static_cast<double>(i) / rateHz;
                real += static_cast<double>(wave[i]) * std::cos(turn);
                imaginary += static_cast<double>(wave[i]) * std::sin(turn);
            }
            return 2.0 * std::hypot(real, imaginary) / static_cast<double>(count);
        };
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
    EXPECT_EQ(heardPeak(silence), 0.0);
}

TEST(ListenTest, AFullScaleOutOfRangeIsRefused) {
    for (const double scale : {0.0, -1.0, std::numeric_limits<double>::infinity()}) {
        EXPECT_THROW(Listen(48000.0, scale), std::invalid_argument) << scale;
    }
}

}  // namespace
}  // namespace haptoflow::effects
