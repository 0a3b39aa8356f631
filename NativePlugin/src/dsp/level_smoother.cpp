#include "dsp/level_smoother.hpp"

#include "dsp/sample_rates.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace haptoflow::dsp {
namespace {

std::uint32_t rampSamplesOf(double sampleRateHz, double rampSeconds) {
    if (!(rampSeconds >= 0.0 && rampSeconds <= 1.0)) {
        throw std::invalid_argument("level smoother: expected a ramp of 0 to 1 s");
    }
    return std::max(1U, static_cast<std::uint32_t>(std::llround(requireSampleRate(sampleRateHz) * rampSeconds)));
}

}  // namespace

LevelSmoother::LevelSmoother(double sampleRateHz, double rampSeconds, float initialGain)
    : rampSamples_(rampSamplesOf(sampleRateHz, rampSeconds)), ramp_(initialGain) {
    if (!std::isfinite(initialGain)) {
        throw std::invalid_argument("level smoother: expected a finite gain");
    }
}

void LevelSmoother::setTarget(float gain) noexcept {
    if (std::isfinite(gain) && gain != ramp_.target()) {
        ramp_.moveTo(gain, rampSamples_);
    }
}

void LevelSmoother::reset(float gain) noexcept {
    if (std::isfinite(gain)) {
        ramp_.jumpTo(gain);
    }
}

void LevelSmoother::process(std::span<float> samples) noexcept {
    if (ramp_.isSettledAt(1.0F)) {
        return;
    }
    for (float& sample : samples) {
        sample *= next();
    }
}

}  // namespace haptoflow::dsp
