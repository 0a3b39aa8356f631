#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

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

/// The largest possible step between neighbouring samples of a voice's wave with magnitude 1. Segments, splices and
/// seeds are joined before the resampler, whose stopband begins at 1,100 Hz, and by Bernstein's inequality a
/// band-limited wave is not steeper than a sinusoid at its band edge. Only the gate follows the resampler; it opens
/// within 2 ms along a raised cosine.
constexpr double steepestStep(double outputRateHz) {
    return std::numbers::pi * (2.0 * 1100.0 + 0.5 / 0.002) / outputRateHz;
}

}  // namespace haptoflow::testing
