#pragma once

#include "support/wave_measures.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <numbers>
#include <random>
#include <span>
#include <vector>

namespace haptoflow::recordings::testing {

inline constexpr double rateHz = 2000.0;

/// Noise of RMS 1 through a resonance at 180 Hz.
inline std::vector<double> resonantNoise(std::size_t samples, unsigned seed) {
    std::mt19937 generator(seed);
    std::normal_distribution<double> normal;
    const double turn = 2.0 * std::numbers::pi * 180.0 / rateHz;
    const double radius = std::exp(-0.5 * turn);
    const double first = 2.0 * radius * std::cos(turn);
    const double second = -radius * radius;
    const double gain = std::sqrt((1.0 + second) * ((1.0 - second) * (1.0 - second) - first * first) / (1.0 - second));
    std::vector<double> wave(samples);
    for (std::size_t i = 2; i < samples; ++i) {
        wave[i] = gain * normal(generator) + first * wave[i - 1] + second * wave[i - 2];
    }
    return wave;
}

/// Noise of this RMS; a colour above 0, up to 1, weakens high frequencies.
inline std::vector<double> hiss(std::size_t samples, double rms, double colour, unsigned seed) {
    std::mt19937 generator(seed);
    std::normal_distribution<double> normal(0.0, rms * std::sqrt(1.0 - colour * colour));
    std::vector<double> wave(samples);
    double last = 0.0;
    for (double& value : wave) {
        last = normal(generator) + colour * last;
        value = last;
    }
    return wave;
}

/// Speeds, each for as long, in m/s.
inline std::vector<double> staircase(std::span<const double> speedsMps, double secondsEach) {
    std::vector<double> speeds;
    for (const double speed : speedsMps) {
        speeds.insert(speeds.end(), static_cast<std::size_t>(secondsEach * rateHz), speed);
    }
    return speeds;
}

/// A texture whose level is `levelAt` the speed, and the same as a noisy sensor measures it.
struct NoisyTexture {
    NoisyTexture(const std::vector<double>& speedsMps, const std::function<double(double)>& levelAt,
                 const std::vector<double>& noise, unsigned seed = 1)
        : isUsable(speedsMps.size(), 1) {
        const std::vector<double> texture = resonantNoise(speedsMps.size(), seed);
        for (std::size_t i = 0; i < speedsMps.size(); ++i) {
            clean.push_back(static_cast<float>(levelAt(speedsMps[i]) * texture[i]));
            wave.push_back(static_cast<float>(clean.back() + noise[i]));
            motion.push_back({static_cast<float>(speedsMps[i]), 0.0F, 1.0F});
        }
    }

    std::vector<float> clean;
    std::vector<float> wave;
    std::vector<std::array<float, 3>> motion;
    std::vector<std::uint8_t> isUsable;
};

inline double meanSquareOf(std::span<const float> wave) {
    return std::pow(10.0, haptoflow::testing::levelDecibels(wave) / 10.0);
}

inline double decibels(double power, double reference) {
    return 10.0 * std::log10(power / reference);
}

}  // namespace haptoflow::recordings::testing
