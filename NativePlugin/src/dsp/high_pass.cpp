#include "dsp/high_pass.hpp"

#include <cmath>
#include <numbers>

namespace haptoflow::dsp {
namespace {

constexpr double cutoffHz = 7.0;

}  // namespace

// The bilinear transform of s^2 / (s^2 + sqrt(2) s + 1), with the cutoff prewarped.
HighPass::HighPass() noexcept {
    const double k = std::tan(std::numbers::pi * cutoffHz / waveformRateHz);
    const double norm = 1.0 / (1.0 + std::numbers::sqrt2 * k + k * k);
    gain_ = norm;
    feedback1_ = 2.0 * (k * k - 1.0) * norm;
    feedback2_ = (1.0 - std::numbers::sqrt2 * k + k * k) * norm;
}

void HighPass::process(std::span<float> samples) noexcept {
    for (float& sample : samples) {
        // Transposed direct form II: numerator 1, -2, 1.
        const double in = static_cast<double>(sample) * gain_;
        const double out = in + first_;
        first_ = second_ - 2.0 * in - feedback1_ * out;
        second_ = in - feedback2_ * out;
        sample = static_cast<float>(out);
    }
}

}  // namespace haptoflow::dsp
