#include "test_signals.hpp"

#include <cmath>
#include <numbers>

// This header needs <cmath> but does not include it.
#include <kissfft/kissfft.hh>

namespace haptoflow::dsp::testing {

std::vector<float> whiteNoise(std::size_t count, double amplitude, std::uint32_t seed) {
    Uniform uniform(seed);
    std::vector<float> samples(count);
    for (float& sample : samples) {
        sample = static_cast<float>(uniform(-amplitude, amplitude));
    }
    return samples;
}

std::vector<float> wholeHertzNoise(std::size_t seconds, int lowestHz, int highestHz, std::size_t sampleRateHz,
                                   std::uint32_t seed) {
    Uniform uniform(seed);
    const double rate = static_cast<double>(sampleRateHz);
    std::vector<double> period(sampleRateHz, 0.0);
    for (int frequency = lowestHz; frequency <= highestHz; ++frequency) {
        const double phase = uniform(0.0, 2.0 * std::numbers::pi);
        for (std::size_t i = 0; i < sampleRateHz; ++i) {
            period[i] += std::sin(phase + 2.0 * std::numbers::pi * frequency * static_cast<double>(i) / rate);
        }
    }
    std::vector<float> samples(seconds * sampleRateHz);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        samples[i] = static_cast<float>(period[i % sampleRateHz]);
    }
    return samples;
}

std::vector<std::complex<double>> lineSpectrum(const std::vector<float>& samples, std::size_t first,
                                               std::size_t count) {
    std::vector<std::complex<double>> input(count);
    for (std::size_t i = 0; i < count; ++i) {
        input[i] = samples.at(first + i);
    }
    std::vector<std::complex<double>> lines(count);
    kissfft<double>(count, false).transform(input.data(), lines.data());
    lines.resize(count / 2 + 1);
    for (auto& line : lines) {
        line *= 2.0 / static_cast<double>(count);
    }
    return lines;
}

double decibels(double amplitudeRatio) {
    return 20.0 * std::log10(amplitudeRatio);
}

}  // namespace haptoflow::dsp::testing
