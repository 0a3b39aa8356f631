#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <span>
#include <vector>

namespace haptoflow::testing {

/// The largest magnitude; 0 for no samples.
inline float peak(std::span<const float> samples) {
    float largest = 0.0F;
    for (const float sample : samples) {
        largest = std::max(largest, std::abs(sample));
    }
    return largest;
}

/// The largest difference between neighbouring samples, including the first sample and `before`, the sample played
/// before it.
inline float largestStepFrom(float before, std::span<const float> samples) {
    float largest = 0.0F;
    for (const float sample : samples) {
        largest = std::max(largest, std::abs(sample - before));
        before = sample;
    }
    return largest;
}

/// The largest difference between neighbouring samples.
inline float largestStep(std::span<const float> samples) {
    return samples.empty() ? 0.0F : largestStepFrom(samples.front(), samples);
}

/// Mean square in decibels.
inline double levelDecibels(std::span<const float> samples) {
    double squares = 0.0;
    for (const float sample : samples) {
        squares += static_cast<double>(sample) * static_cast<double>(sample);
    }
    return 10.0 * std::log10(squares / static_cast<double>(samples.size()));
}

inline double rms(std::span<const float> samples) {
    return std::pow(10.0, levelDecibels(samples) / 20.0);
}

/// amplitude sin(2 pi frequency t).
inline std::vector<float> sine(double frequencyHz, double amplitude, double seconds, double rateHz) {
    std::vector<float> wave(static_cast<std::size_t>(seconds * rateHz));
    for (std::size_t i = 0; i < wave.size(); ++i) {
        const double cycles = frequencyHz * static_cast<double>(i) / rateHz;
        wave[i] = static_cast<float>(amplitude * std::sin(2.0 * std::numbers::pi * cycles));
    }
    return wave;
}

/// The amplitude at a frequency, of which the samples hold a whole number of periods.
inline double amplitudeAt(std::span<const float> samples, double frequencyHz, double rateHz) {
    std::complex<double> sum = 0.0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const double cycles = frequencyHz * static_cast<double>(i) / rateHz;
        sum += static_cast<double>(samples[i]) * std::polar(1.0, -2.0 * std::numbers::pi * cycles);
    }
    return 2.0 * std::abs(sum) / static_cast<double>(samples.size());
}

/// The largest possible step between neighbouring samples of a voice's wave with magnitude 1. Segments, splices and
/// seeds are joined before the resampler, whose stopband begins at 1,100 Hz, and by Bernstein's inequality a
/// band-limited wave is not steeper than a sinusoid at its band edge. Only the gate follows the resampler; it opens
/// within 2 ms along a raised cosine.
constexpr double steepestStep(double outputRateHz) {
    return std::numbers::pi * (2.0 * 1100.0 + 0.5 / 0.002) / outputRateHz;
}

}  // namespace haptoflow::testing
