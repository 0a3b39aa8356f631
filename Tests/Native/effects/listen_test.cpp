#include "effects/device_loudness.hpp"

#include "support/counting_new.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <stdexcept>
#include <vector>

namespace haptoflow::effects {
namespace {

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

TEST(ListenTest, AnyInputGivesFiniteSamplesWithinTheFullScaleOfTheLimiterAfterIt) {
    for (const double rateHz : listenRateHz) {
        Listen listen(rateHz, listenFullScaleMps2);
        listen.reset();
        std::vector<float> wave(static_cast<std::size_t>(rateHz), 3.0F);
        wave[3] = std::nanf("");
        wave[500] = INFINITY;
        wave[1200] = -std::numeric_limits<float>::max();
        wave[2000] = 1e-42F;
        listen.process(wave);
        for (const float sample : wave) {
            ASSERT_TRUE(std::isfinite(sample)) << sample;
            ASSERT_LE(std::abs(sample), listenFullScaleMps2) << rateHz;
        }
    }
}

TEST(ListenTest, AfterItsTailItIsIdleAndSilent) {
    Listen listen(48000.0, listenFullScaleMps2);
    EXPECT_TRUE(listen.isIdle());
    std::vector<float> wave(4800, 5.0F);
    listen.process(wave);
    EXPECT_FALSE(listen.isIdle());
    std::vector<float> silence(static_cast<std::size_t>(48000.0 * listen.declaration().tailSeconds), 0.0F);
    listen.process(silence);
    EXPECT_TRUE(listen.isIdle());
    std::ranges::fill(silence, 0.0F);
    listen.process(silence);
    EXPECT_EQ(heardPeak(silence), 0.0);
}

TEST(ListenTest, AFullScaleOrRateOutOfRangeIsRefused) {
    EXPECT_THROW(Listen(7000.0, 200.0), std::invalid_argument);
    for (const double scale : {0.0, -1.0, std::numeric_limits<double>::infinity()}) {
        EXPECT_THROW(Listen(48000.0, scale), std::invalid_argument) << scale;
    }
}

TEST(ListenTest, ProcessingAllocatesNothing) {
    Listen listen(48000.0, listenFullScaleMps2);
    std::vector<float> wave(4800, 1.0F);
    const std::size_t before = haptoflow::testing::allocationCount();
    listen.process(wave);
    (void)listen.isIdle();
    listen.reset();
    EXPECT_EQ(haptoflow::testing::allocationCount(), before);
}

}  // namespace
}  // namespace haptoflow::effects
