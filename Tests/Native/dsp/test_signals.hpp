#pragma once

#include <complex>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

namespace haptoflow::dsp::testing {

/// Uniform numbers in [lowest, highest); the sequence is the same with every standard library.
class Uniform {
public:
    explicit Uniform(std::uint32_t seed) : engine_(seed) {}
    double operator()(double lowest, double highest) {
        return lowest + (highest - lowest) * (static_cast<double>(engine_()) / 4294967296.0);
    }
    /// An integer in [lowest, highest].
    std::size_t whole(std::size_t lowest, std::size_t highest) { return lowest + engine_() % (highest - lowest + 1); }

private:
    std::mt19937 engine_;
};

/// White noise, uniform in +-amplitude.
std::vector<float> whiteNoise(std::size_t count, double amplitude, std::uint32_t seed);

/// Noise with a period of one second: a unit sinusoid with random phase at every whole hertz from `lowestHz` to
/// `highestHz`. The spectrum of one period is exact without a window.
std::vector<float> wholeHertzNoise(std::size_t seconds, int lowestHz, int highestHz, std::size_t sampleRateHz,
                                   std::uint32_t seed);

/// Complex amplitudes of the spectral lines 0 to count/2 of `count` samples from `first`; 1 for a unit sinusoid with
/// whole periods.
std::vector<std::complex<double>> lineSpectrum(const std::vector<float>& samples, std::size_t first, std::size_t count);

double decibels(double amplitudeRatio);

}  // namespace haptoflow::dsp::testing
