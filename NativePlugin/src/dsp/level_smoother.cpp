#include "dsp/level_smoother.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace haptoflow::dsp {

LevelSmoother::LevelSmoother(double sampleRateHz, double rampSeconds, float initialGain)
    : current_(initialGain), target_(initialGain) {
    if (!(sampleRateHz > 0.0 && sampleRateHz <= 768000.0 && rampSeconds >= 0.0 && rampSeconds <= 1.0 &&
          std::isfinite(initialGain))) {
        throw std::invalid_argument(
            "level smoother: expected a sample rate above 0 up to 768000 Hz, a ramp of 0 to 1 s and a finite gain");
    }
    rampSamples_ = std::max<std::size_t>(1, static_cast<std::size_t>(std::llround(sampleRateHz * rampSeconds)));
}

void LevelSmoother::setTarget(float gain) noexcept {
    if (!std::isfinite(gain) || gain == target_) {
        return;
    }
    target_ = gain;
    remaining_ = rampSamples_;
    step_ = (static_cast<double>(gain) - current_) / static_cast<double>(rampSamples_);
}

void LevelSmoother::reset(float gain) noexcept {
    if (std::isfinite(gain)) {
        target_ = gain;
        current_ = gain;
        remaining_ = 0;
    }
}

float LevelSmoother::next() noexcept {
    if (remaining_ > 0) {
        --remaining_;
        current_ = remaining_ == 0 ? static_cast<double>(target_) : current_ + step_;
    }
    return static_cast<float>(current_);
}

void LevelSmoother::process(std::span<float> samples) noexcept {
    if (isSettled() && target_ == 1.0F) {
        return;
    }
    for (float& sample : samples) {
        sample *= next();
    }
}

}  // namespace haptoflow::dsp
