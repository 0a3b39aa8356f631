#pragma once

#include "clips/haptic_clip.hpp"
#include "support/wave_measures.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <vector>

namespace haptoflow::clips {

inline constexpr double testRateHz = 2000.0;

inline std::vector<float> sine(double frequencyHz, double amplitude, double seconds) {
    return haptoflow::testing::sine(frequencyHz, amplitude, seconds, testRateHz);
}

inline std::vector<float> noise(double amplitude, double seconds, unsigned seed = 1) {
    std::mt19937 engine(seed);
    std::normal_distribution<float> normal(0.0F, static_cast<float>(amplitude));
    std::vector<float> wave(static_cast<std::size_t>(seconds * testRateHz));
    std::ranges::generate(wave, [&] { return normal(engine); });
    return wave;
}

/// A decaying sinusoid from `start` on.
inline void addTap(std::vector<float>& wave, double start, double amplitude, double frequencyHz = 200.0) {
    for (auto i = static_cast<std::size_t>(start * testRateHz); i < wave.size(); ++i) {
        const double seconds = static_cast<double>(i) / testRateHz - start;
        wave[i] += static_cast<float>(amplitude * std::exp(-seconds / 0.008) *
                                      std::sin(2.0 * std::numbers::pi * frequencyHz * seconds));
    }
}

}  // namespace haptoflow::clips
