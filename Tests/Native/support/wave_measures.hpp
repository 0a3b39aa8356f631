#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

namespace haptoflow::testing {

/// The largest magnitude; 0 of nothing.
inline float peak(std::span<const float> samples) {
    float largest = 0.0F;
    for (const float sample : samples) {
        largest = std::max(largest, std::abs(sample));
    }
    return largest;
}

/// The largest difference between neighbours, the first sample's from what was heard before it included.
inline float largestStepFrom(float before, std::span<const float> samples) {
    float largest = 0.0F;
    for (const float sample : samples) {
        largest = std::max(largest, std::abs(sample - before));
        before = sample;
    }
    return largest;
}

/// The largest difference between neighbours.
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

/// The steepest that a voice's wave of magnitude 1 can be at an output rate. Segments, their splices and seeds are
/// joined before the resampler, whose stopband begins at 1,100 Hz: no sum of such tones is steeper than one of them
/// (Bernstein). Only the gate comes after it, and opens within 2 ms on a raised cosine.
constexpr double steepestStep(double outputRateHz) {
    return std::numbers::pi * (2.0 * 1100.0 + 0.5 / 0.002) / outputRateHz;
}

}  // namespace haptoflow::testing
