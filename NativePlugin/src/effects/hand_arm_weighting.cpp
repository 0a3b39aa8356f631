#include "effects/hand_arm_weighting.hpp"

#include <cmath>
#include <numbers>

namespace haptoflow::effects {
namespace {

constexpr double highPassHz = 6.310;
constexpr double lowPassHz = 1258.9;
constexpr double transitionHz = 15.915;
constexpr double transitionQuality = 0.64;

struct Analogue {
    double frequencyHz;
    double quality;
    /// Coefficients of (s / w)^2, s / w and 1 in the numerator.
    double squared;
    double linear;
    double constant;
};

}  // namespace

HandArmWeighting::HandArmWeighting(double sampleRateHz) noexcept : sections_{} {
    const std::array<Analogue, 3> analogues{{{highPassHz, 1.0 / std::numbers::sqrt2, 1.0, 0.0, 0.0},
                                             {lowPassHz, 1.0 / std::numbers::sqrt2, 0.0, 0.0, 1.0},
                                             {transitionHz, transitionQuality, 0.0, 1.0, 1.0}}};
    for (std::size_t i = 0; i < sections_.size(); ++i) {
        const Analogue& analogue = analogues[i];
        // s / w = (1 - z^-1) / (k (1 + z^-1)), exact at the section's own frequency.
        const double k = std::tan(std::numbers::pi * analogue.frequencyHz / sampleRateHz);
        const double scale = 1.0 / (1.0 + k / analogue.quality + k * k);
        Section& section = sections_[i];
        section.b0 = (analogue.squared + analogue.linear * k + analogue.constant * k * k) * scale;
        section.b1 = 2.0 * (analogue.constant * k * k - analogue.squared) * scale;
        section.b2 = (analogue.squared - analogue.linear * k + analogue.constant * k * k) * scale;
        section.a1 = 2.0 * (k * k - 1.0) * scale;
        section.a2 = (1.0 - k / analogue.quality + k * k) * scale;
    }
}

double HandArmWeighting::next(double mps2) noexcept {
    double value = mps2;
    for (Section& section : sections_) {
        const double out = section.b0 * value + section.first;
        section.first = section.b1 * value - section.a1 * out + section.second;
        section.second = section.b2 * value - section.a2 * out;
        value = out;
    }
    return value;
}

void HandArmWeighting::reset() noexcept {
    for (Section& section : sections_) {
        section.first = 0.0;
        section.second = 0.0;
    }
}

}  // namespace haptoflow::effects
