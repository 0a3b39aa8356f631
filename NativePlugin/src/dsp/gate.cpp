#include "dsp/gate.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

namespace haptoflow::dsp {
namespace {

constexpr double openSeconds = 0.002;
constexpr double closeSeconds = 0.005;

std::uint64_t wholeSamples(double seconds, double sampleRateHz) {
    // The nudge keeps 0.005 s x 2,000 Hz from becoming 9 samples by rounding.
    return std::max<std::uint64_t>(1, static_cast<std::uint64_t>(seconds * sampleRateHz + 1e-6));
}

double checkedRate(double sampleRateHz) {
    if (!(sampleRateHz >= 500.0 && sampleRateHz <= 768000.0)) {
        throw std::invalid_argument("gate sample rate is " + std::to_string(sampleRateHz) +
                                    " Hz; expected 500 to 768000 Hz");
    }
    return sampleRateHz;
}

}  // namespace

Gate::Gate(double sampleRateHz)
    : openSamples_(wholeSamples(openSeconds, checkedRate(sampleRateHz))),
      closeSamples_(wholeSamples(closeSeconds, sampleRateHz)) {}

void Gate::reset() noexcept {
    position_ = 0;
    opening_ = false;
}

float Gate::nextGain() noexcept {
    const std::uint64_t full = fullyOpen();
    if (opening_) {
        position_ = std::min(position_ + closeSamples_, full);
    } else {
        position_ -= std::min(position_, openSamples_);
    }
    if (position_ == 0) {
        return 0.0F;
    }
    if (position_ == full) {
        return 1.0F;
    }
    const double progress = static_cast<double>(position_) / static_cast<double>(full);
    return static_cast<float>(0.5 - 0.5 * std::cos(std::numbers::pi * progress));
}

void Gate::process(std::span<float> samples) noexcept {
    for (float& sample : samples) {
        const float gain = nextGain();
        if (gain == 0.0F) {
            sample = 0.0F;
        } else if (gain != 1.0F) {
            sample *= gain;
        }
    }
}

}  // namespace haptoflow::dsp
