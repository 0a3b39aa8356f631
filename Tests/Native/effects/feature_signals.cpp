#include "effects/feature_signals.hpp"

#include "support/wave_measures.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace haptoflow::effects::testing {
namespace {

constexpr double waveRateHz = 2000.0;

}  // namespace

std::vector<float> featureSine(double frequencyHz, double amplitudeMps2, double seconds) {
    return haptoflow::testing::sine(frequencyHz, amplitudeMps2, seconds, waveRateHz);
}

std::vector<float> featureNoise(double rmsMps2, double seconds, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal(0.0, rmsMps2);
    std::vector<float> wave(static_cast<std::size_t>(seconds * waveRateHz));
    std::ranges::generate(wave, [&] { return static_cast<float>(normal(random)); });
    return wave;
}

std::vector<float> textureNoise(double rmsMps2, double seconds, unsigned seed) {
    std::vector<float> wave = featureNoise(1.0, seconds, seed);
    double first = 0.0;
    double second = 0.0;
    double slow = 0.0;
    for (float& sample : wave) {
        first += 0.6 * (static_cast<double>(sample) - first);
        second += 0.6 * (first - second);
        slow += 0.12 * (second - slow);
        sample = static_cast<float>(second - slow);
    }
    const double scale = rmsMps2 / haptoflow::testing::rms(wave);
    for (float& sample : wave) {
        sample = static_cast<float>(scale * static_cast<double>(sample));
    }
    return wave;
}

std::vector<float> decayingSinusoidFrom(std::size_t start, double frequencyHz, double amplitudeMps2,
                                        double decayPerSecond, double seconds) {
    std::vector<float> wave(static_cast<std::size_t>(seconds * waveRateHz), 0.0F);
    for (std::size_t i = start; i < wave.size(); ++i) {
        const double elapsed = static_cast<double>(i - start) / waveRateHz;
        wave[i] = static_cast<float>(amplitudeMps2 * std::exp(-decayPerSecond * elapsed) *
                                     std::sin(2.0 * std::numbers::pi * frequencyHz * elapsed));
    }
    return wave;
}

}  // namespace haptoflow::effects::testing
