#pragma once

#include <algorithm>
#include <cmath>
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

}  // namespace haptoflow::testing
