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

    /// Filters at most 32 samples of `drive`, continuing from `past`, the 24 samples before it, which become those
    /// before the next call. Writes the result limited to +-64, what is not a number as 0; the recursion itself is not
    /// limited. No allocation.
    void run(std::array<double, filterOrder>& past, std::span<const float> drive,
             std::span<float> filtered) const noexcept;

    /// A past that noise of standard deviation 1 would have led to, made of `noise`, standard normal numbers: each
    /// sample is predicted from those before it, with the error that a filter of that many coefficients leaves
    /// (step-down recursion: Markel and Gray, "Linear prediction of speech", 1976, section 5.2). No allocation.
    [[nodiscard]] std::array<double, filterOrder> stationaryPast(
        std::span<const float, filterOrder> noise) const noexcept;
    /// Mean square of what comes out for noise of standard deviation 1.
    [[nodiscard]] double variance() const noexcept;
    /// What comes out of a sinusoid of this frequency, as a factor on its power.
    [[nodiscard]] double powerGain(double frequencyHz) const noexcept;
};

}  // namespace haptoflow::skeleton
