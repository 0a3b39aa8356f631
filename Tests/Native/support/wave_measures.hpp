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

inline double sumOfSquares(std::span<const float> samples) {
    double squares = 0.0;
    for (const float sample : samples) {
        squares += static_cast<double>(sample) * static_cast<double>(sample);
    }
    return squares;
}

/// Mean square in decibels.
inline double levelDecibels(std::span<const float> samples) {
    return 10.0 * std::log10(sumOfSquares(samples) / static_cast<double>(samples.size()));
}

/// The normalised product of two waves of one length; no mean is taken off.
inline double correlation(std::span<const float> left, std::span<const float> right) {
    double product = 0.0;
    for (std::size_t i = 0; i < left.size(); ++i) {
        product += static_cast<double>(left[i]) * static_cast<double>(right[i]);
    }
    return product / std::sqrt(sumOfSquares(left) * sumOfSquares(right));
}

/// A sinusoid of amplitude 1.
inline std::vector<float> sinusoid(std::size_t count, double frequencyHz, double rateHz = 2000.0) {
    std::vector<float> samples(count);
    for (std::size_t i = 0; i < count; ++i) {
        samples[i] =
            static_cast<float>(std::sin(2.0 * std::numbers::pi * frequencyHz * static_cast<double>(i) / rateHz));
    }
    return samples;
}

/// Gain in decibels of a filter with these taps at 2 kHz.
template <typename Taps>
double gainDecibels(const Taps& taps, double frequencyHz) {
    std::complex<double> sum = 0.0;
    for (std::size_t tap = 0; tap < taps.size(); ++tap) {
        sum += static_cast<double>(taps[tap]) *
               std::polar(1.0, -2.0 * std::numbers::pi * frequencyHz * static_cast<double>(tap) / 2000.0);
    }
    return 20.0 * std::log10(std::abs(sum));
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
