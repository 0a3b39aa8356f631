#include "dsp/limiter.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace haptoflow::dsp {
namespace {

constexpr float largestBelowOne = 0x1.fffffep-1F;

// With u = (x - k) / (1 - k) the curve is k + (1 - k) u / (1 + u): slope 1 at the knee, asymptote 1. This form of it
// survives x = infinity; the clamp catches the last bit's rounding at either end.
float bend(float aboveKnee) noexcept {
    constexpr float headroom = 1.0F - SoftLimiter::knee;
    const float distance = headroom * headroom / (headroom + (aboveKnee - SoftLimiter::knee));
    return std::clamp(1.0F - distance, SoftLimiter::knee, largestBelowOne);
}

}  // namespace

SoftLimiter::SoftLimiter(float fullScaleMps2) : fullScaleMps2_(fullScaleMps2) {
    if (!(std::isfinite(fullScaleMps2) && fullScaleMps2 > 0.0F)) {
        throw std::invalid_argument("full_scale_mps2 is " + std::to_string(fullScaleMps2) +
                                    "; expected a finite number above 0");
    }
}

float SoftLimiter::limit(float mps2) const noexcept {
    if (!std::isfinite(mps2)) {
        return 0.0F;
    }
    const float scaled = mps2 / fullScaleMps2_;
    const float magnitude = std::abs(scaled);
    return magnitude <= knee ? scaled : std::copysign(bend(magnitude), scaled);
}

void SoftLimiter::process(std::span<float> samples) noexcept {
    for (float& sample : samples) {
        if (!std::isfinite(sample)) {
            ++nonFiniteCount_;
        }
        sample = limit(sample);
        if (std::abs(sample) > knee) {
            ++limitedCount_;
        }
    }
}

}  // namespace haptoflow::dsp
