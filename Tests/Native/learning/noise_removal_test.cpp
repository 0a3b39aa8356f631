#include "recordings/sensor_noise.hpp"

#include "learning/noisy_texture.hpp"
#include "recordings/recording.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace haptoflow::recordings {
namespace {

using namespace testing;
using ::testing::HasSubstr;

constexpr double noiseMps2 = 0.038;
constexpr std::array speeds{0.0, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.3};
/// Long enough that the power of the noise itself varies by little: at 5 mm/s it is four times that of the texture.
constexpr double secondsEach = 16.0;

double smooth(double speedMps) {
    return 0.3 * std::pow(speedMps / 0.1, 0.9);
}

SensorNoise remove(NoisyTexture& texture) {
    return removeSensorNoise(texture.wave, texture.motion, texture.isUsable);
}

/// Mean power of the frames in these samples, summed over the bins from `first` to before `end`.
double bandPower(std::span<const float> wave, std::size_t first, std::size_t end) {
    const SpectrumCells power = ShortTimeSpectrum(wave).power();
    double sum = 0.0;
    for (std::size_t cell = 0; cell < power.size(); ++cell) {
        const std::size_t bin = cell % ShortTimeSpectrum::bins;
        sum += bin >= first && bin < end ? power[cell] : 0.0;
    }
    return sum;
}

/// Step number `step` of a staircase, without its edges.
std::span<const float> stepOf(const std::vector<float>& wave, std::size_t step) {
    const auto length = static_cast<std::size_t>(secondsEach * rateHz);
    return std::span(wave).subspan(step * length + 400, length - 800);
}

struct NoisyStaircase : ::testing::TestWithParam<double> {
    std::vector<double> speedsMps = staircase(speeds, secondsEach);
    NoisyTexture texture{speedsMps, smooth, hiss(speedsMps.size(), noiseMps2, GetParam(), 2)};
};

TEST_P(NoisyStaircase, TheNoiseIsFoundAtRest) {
    const SensorNoise noise = remove(texture);
    EXPECT_EQ(noise.source, NoiseSource::rest);
    EXPECT_NEAR(decibels(noise.rmsMps2, noiseMps2), 0.0, 0.3);
}

TEST_P(NoisyStaircase, TheLevelOfSlowAndFastSlidingIsThatOfTheTextureAlone) {
    const NoisyTexture measured = texture;
    (void)remove(texture);
    for (std::size_t step = 1; step < speeds.size(); ++step) {
        const double truth = meanSquareOf(stepOf(texture.clean, step));
        const double before = decibels(meanSquareOf(stepOf(measured.wave, step)), truth);
        const double after = decibels(meanSquareOf(stepOf(texture.wave, step)), truth);
        EXPECT_NEAR(after, 0.0, speeds[step] >= 0.05 ? 0.1 : 1.0) << speeds[step];
        EXPECT_GT(before, speeds[step] > 0.005 ? 0.0 : 5.0);
    }
}

TEST_P(NoisyStaircase, TheSpectrumIsThatOfTheTextureAlone) {
    constexpr std::array edges{1, 4, 7, 10, 13, 20, 26, 39, 58};
    const NoisyTexture measured = texture;
    (void)remove(texture);
    for (std::size_t step = 1; step < speeds.size(); ++step) {
        double meanBefore = 0.0;
        double meanAfter = 0.0;
        for (std::size_t band = 0; band + 1 < edges.size(); ++band) {
            const auto inBand = [&](const std::vector<float>& wave) {
                return bandPower(stepOf(wave, step), static_cast<std::size_t>(edges[band]),
                                 static_cast<std::size_t>(edges[band + 1]));
            };
            const double truth = inBand(texture.clean);
            meanBefore += std::abs(decibels(inBand(measured.wave), truth)) / (edges.size() - 1);
            meanAfter += std::abs(decibels(inBand(texture.wave), truth)) / (edges.size() - 1);
        }
        EXPECT_LT(meanAfter, 0.4 * meanBefore + 0.05) << speeds[step];
    }
}

INSTANTIATE_TEST_SUITE_P(WhiteAndColoured, NoisyStaircase, ::testing::Values(0.0, 0.9));

struct Untouched {
    const char* what;
    std::vector<double> speedsMps;
    std::function<double(double)> level;
    double hissMps2;
};

TEST(NoiseRemoval, WhereNoNoiseIsFoundTheWaveKeepsEveryBit) {
    const auto like = [](double exponent) {
        return [exponent](double speed) { return 0.3 * std::pow(speed / 0.1, exponent); };
    };
    const std::vector<double> slow = staircase(std::array{0.004, 0.006, 0.009, 0.013, 0.05, 0.1, 0.2}, 3.0);
    const std::vector<Untouched> cases{
        {"without noise", staircase(speeds, 1.0), smooth, 0.0},
        {"never at rest", staircase(std::array{0.2}, 10.0), smooth, noiseMps2},
        {"never slow", staircase(std::array{0.03, 0.1, 0.3}, 4.0), smooth, noiseMps2},
        {"a level that does not follow the speed", staircase(std::array{0.005, 0.008, 0.012, 0.05, 0.1}, 3.0),
         [](double) { return 0.05; }, 0.001},
        {"clean and slow, level as the speed's root", slow, like(0.5), 0.0},
        {"clean and slow, level faster than the speed", slow, like(1.3), 0.0},
        {"silence", staircase(std::array{0.0, 0.1}, 2.0), [](double) { return 0.0; }, 0.0},
        {"nothing", {}, smooth, noiseMps2},
        {"a hop and a bit", std::vector<double>(200), smooth, noiseMps2},
    };
    for (const Untouched& each : cases) {
        NoisyTexture texture(each.speedsMps, each.level, hiss(each.speedsMps.size(), each.hissMps2, 0.0, 4));
        const std::vector<float> measured = texture.wave;
        EXPECT_EQ(remove(texture).source, NoiseSource::none) << each.what;
        EXPECT_EQ(texture.wave, measured) << each.what;
    }
    // A tracker that holds still while the tip slides costs no texture.
    const std::vector<double> speedsMps = staircase(std::array{0.02, 0.2, 0.05, 0.1}, secondsEach);
    NoisyTexture texture(speedsMps, smooth, std::vector<double>(speedsMps.size()));
    for (std::size_t i = 40'000; i < 44'000; ++i) {
        texture.motion[i][0] = 0.0F;
    }
    EXPECT_EQ(remove(texture).source, NoiseSource::none);
    EXPECT_EQ(texture.wave, texture.clean);
}

TEST(NoiseRemoval, WithoutRestTheNoiseIsFoundInTheQuietPart) {
    const std::array slowAndFast{0.004, 0.006, 0.008, 0.05, 0.1, 0.2};
    const std::vector<double> speedsMps = staircase(slowAndFast, secondsEach);
    NoisyTexture texture(speedsMps, smooth, hiss(speedsMps.size(), noiseMps2, 0.0, 6));
    const NoisyTexture measured = texture;
    const SensorNoise noise = remove(texture);
    EXPECT_EQ(noise.source, NoiseSource::quietPart);
    EXPECT_NEAR(decibels(noise.rmsMps2 * noise.rmsMps2, noiseMps2 * noiseMps2), -0.8, 0.5)
        << "rather too little than too much";
    for (std::size_t step = 0; step < slowAndFast.size(); ++step) {
        const double truth = meanSquareOf(stepOf(texture.clean, step));
        const double after = decibels(meanSquareOf(stepOf(texture.wave, step)), truth);
        const double before = decibels(meanSquareOf(stepOf(measured.wave, step)), truth);
        EXPECT_GT(after, -0.1) << slowAndFast[step];
        EXPECT_LT(after, 0.5 * before + 0.05) << slowAndFast[step];
    }
}

TEST(NoiseRemoval, ARecordingOfNothingButHissIsRefused) {
    const std::vector<double> speedsMps = staircase(speeds, 2.0);
    NoisyTexture texture(
        speedsMps, [](double) { return 0.0; }, hiss(speedsMps.size(), noiseMps2, 0.9, 8));
    EXPECT_THAT([&] { (void)remove(texture); }, ::testing::ThrowsMessage<RecordingUnusable>(HasSubstr(
                                                    "no stronger where the tip slides than where it rests (0.0")));
}

TEST(NoiseRemoval, AttacksKeepTheirPeakAndTheirTime) {
    const std::vector<double> speedsMps = staircase(std::array{0.0, 0.01, 0.1}, 4.0);
    NoisyTexture texture(speedsMps, smooth, hiss(speedsMps.size(), noiseMps2, 0.0, 9));
    std::vector<std::size_t> attacks;
    for (std::size_t at = 9000; at + 500 < texture.wave.size(); at += 731) {
        attacks.push_back(at);
        for (std::size_t i = 0; i < 60; ++i) {
            const double time = static_cast<double>(i) / rateHz;
            texture.wave[at + i] +=
                static_cast<float>(1.5 * std::exp(-time / 0.004) * std::cos(2.0 * std::numbers::pi * 250.0 * time));
        }
    }
    const std::vector<float> measured = texture.wave;
    (void)remove(texture);
    for (const std::size_t at : attacks) {
        const auto peakOf = [&](const std::vector<float>& wave) {
            const auto around = std::span(wave).subspan(at - 40, 100);
            return std::ranges::max_element(around, {}, [](float value) { return std::abs(value); }) - around.begin();
        };
        const auto index = at - 40 + static_cast<std::size_t>(peakOf(measured));
        EXPECT_EQ(peakOf(texture.wave), peakOf(measured)) << at;
        EXPECT_NEAR(20.0 * std::log10(std::abs(texture.wave[index] / measured[index])), 0.0, 1.0) << at;
    }
}

TEST(NoiseRemoval, AKnockAtRestIsNotNoise) {
    const std::vector<double> speedsMps = staircase(std::array{0.0, 0.05, 0.1}, 2.0);
    NoisyTexture texture(speedsMps, smooth, hiss(speedsMps.size(), noiseMps2, 0.0, 10));
    std::fill_n(texture.wave.begin() + 1500, 40, 3.0F);
    EXPECT_NEAR(decibels(remove(texture).rmsMps2, noiseMps2), 0.0, 0.5);
}

TEST(NoiseRemoval, ATipThatRestsUnderATrackerWithNoiseIsAtRestAndACreepingOneIsNot) {
    const std::vector<double> speedsMps = staircase(std::array{0.0, 0.05, 0.1}, 3.0);
    NoisyTexture texture(speedsMps, smooth, hiss(speedsMps.size(), noiseMps2, 0.0, 15));
    NoisyTexture creeping = texture;
    const std::vector<double> jitter = hiss(speedsMps.size(), 0.001, 0.99, 16);
    for (std::size_t i = 0; i < jitter.size(); ++i) {
        texture.motion[i][0] += static_cast<float>(jitter[i]);
        creeping.motion[i][0] = std::max(creeping.motion[i][0], 0.003F);
    }
    EXPECT_EQ(remove(texture).source, NoiseSource::rest);
    EXPECT_EQ(remove(creeping).source, NoiseSource::none);
}

TEST(NoiseRemoval, ATipThatHoversSlowlyInTheAirIsAtRest) {
    const std::vector<double> speedsMps = staircase(std::array{0.01, 0.05, 0.1}, 3.0);
    NoisyTexture texture(
        speedsMps, [](double speed) { return speed > 0.02 ? smooth(speed) : 0.0; },
        hiss(speedsMps.size(), noiseMps2, 0.0, 17));
    std::for_each_n(texture.motion.begin(), 6000, [](std::array<float, 3>& each) { each[2] = 0.0F; });
    EXPECT_EQ(remove(texture).source, NoiseSource::rest);
}

TEST(NoiseRemoval, APartThatIsUnknownIsNeitherRestNorChanged) {
    const std::vector<double> speedsMps = staircase(std::array{0.0, 0.01, 0.1}, 4.0);
    NoisyTexture texture(speedsMps, smooth, hiss(speedsMps.size(), noiseMps2, 0.0, 11));
    for (std::size_t i = 2000; i < 6000; ++i) {
        texture.wave[i] = 0.0F;
        texture.isUsable[i] = 0;
    }
    EXPECT_NEAR(decibels(remove(texture).rmsMps2, noiseMps2), 0.0, 0.5);
    EXPECT_TRUE(std::ranges::all_of(std::span(texture.wave).subspan(2200, 3600),
                                    [](float value) { return std::abs(value) < 1e-6F; }));
}

TEST(ShortTimeSpectrumTest, WhatIsNotScaledComesBack) {
    for (const std::size_t samples : {1U, 63U, 64U, 65U, 1000U}) {
        const std::vector<double> noise = hiss(samples, 1.0, 0.0, 13);
        const std::vector<float> wave(noise.begin(), noise.end());
        const std::vector<float> back = ShortTimeSpectrum(wave).wave();
        ASSERT_EQ(back.size(), samples);
        for (std::size_t i = 0; i < samples; ++i) {
            EXPECT_NEAR(back[i], wave[i], 1e-6F);
        }
    }
}

}  // namespace
}  // namespace haptoflow::recordings
