#include "dsp/limiter.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

namespace haptoflow::dsp {
namespace {

constexpr double cutoffHz = 7.0;

/// The largest float below a ceiling of 0 to 1; 0 for a ceiling of 0.
float largestBelow(float ceiling) noexcept {
    return std::nextafter(ceiling, 0.0F);
}

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

SoftLimiter::SoftLimiter(float fullScaleMps2) : fullScaleMps2_(fullScaleMps2), largestOutput_(largestBelow(1.0F)) {
    if (!(std::isfinite(fullScaleMps2) && fullScaleMps2 > 0.0F)) {
        throw std::invalid_argument("full_scale_mps2 is " + std::to_string(fullScaleMps2) +
                                    "; expected a finite number above 0");
    }
}

void SoftLimiter::setCeiling(float ceiling) noexcept {
    if (std::isfinite(ceiling)) {
        ceiling_ = std::clamp(ceiling, 0.0F, 1.0F);
        kneeStart_ = knee * ceiling_;
        largestOutput_ = largestBelow(ceiling_);
    }
}

// With knee k, ceiling c and u = (x - k) / (c - k), the curve is k + (c - k) u / (1 + u): slope 1 at the knee,
// asymptote c. This form is valid for x = infinity; the clamp corrects rounding of the last bit at both ends.
float SoftLimiter::bend(float aboveKnee) const noexcept {
    const float headroom = ceiling_ - kneeStart_;
    const float distance = headroom * headroom / (headroom + (aboveKnee - kneeStart_));
    return std::clamp(ceiling_ - distance, std::min(kneeStart_, largestOutput_), largestOutput_);
}

void SoftLimiter::scale(std::span<float> samples) noexcept {
    for (float& sample : samples) {
        if (!std::isfinite(sample)) {
            ++nonFiniteCount_;
            sample = 0.0F;
        }
        sample /= fullScaleMps2_;
    }
}

void SoftLimiter::processScaled(std::span<float> samples) noexcept {
    for (float& sample : samples) {
        const float magnitude = std::abs(sample);
        // In this form a NaN is limited, too.
        if (!(magnitude <= kneeStart_)) {
            sample = std::copysign(bend(magnitude), sample);
            limitedCount_ += std::abs(sample) > kneeStart_ ? 1U : 0U;
        }
    }
}

}  // namespace haptoflow::dsp
