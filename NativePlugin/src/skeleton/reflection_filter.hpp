#pragma once

#include "skeleton/skeleton_layout.hpp"

#include <array>
#include <span>

namespace haptoflow::skeleton {

/// The contact's resonance: an all-pole filter 1 / A(z), A(z) = 1 + sum a_i z^-i, through which passes all that drives
/// the tip. It is stable for any parameters: its reflection coefficients are below 1, their resonance is at most 50 dB,
/// and its poles are drawn inwards.
struct ReflectionFilter {
    /// a_1 to a_24.
    std::array<double, filterOrder> coefficients{};
    /// Natural logarithm of the gain of all that drives the filter.
    double logGain = 0.0;

    /// Of the perceptron's outputs: the reflections before their tanh, and the gain.
    [[nodiscard]] static ReflectionFilter of(std::span<const float, filterOrder> reflections, float gain) noexcept;

    /// Filters `drive`, continuing from `past`, the 24 samples before it, and writes the result limited to +-16. The
    /// recursion itself is not limited. No allocation.
    void run(std::span<const float, filterOrder> past, Segment drive,
             std::span<float, segmentSamples> filtered) const noexcept;
};

}  // namespace haptoflow::skeleton
