#include "dsp/gate.hpp"

#include "dsp/sample_rates.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace haptoflow::dsp {
namespace {

std::uint32_t rampSamplesOf(double sampleRateHz, double rampSeconds) {
    if (!(rampSeconds >= 0.0 && rampSeconds <= 1.0)) {
        throw std::invalid_argument("level smoother: expected a ramp of 0 to 1 s");
    }
    return std::max(1U, static_cast<std::uint32_t>(std::llround(requireSampleRate(sampleRateHz) * rampSeconds)));
}

constexpr double openSeconds = 0.002;

std::uint64_t wholeSamples(double seconds, double sampleRateHz) {
    // The small addition keeps rounding from turning 0.005 s at 2,000 Hz into 9 samples.
    return std::max<std::uint64_t>(1, static_cast<std::uint64_t>(seconds * sampleRateHz + 1e-6));
}

/// Half a period of a raised cosine, from 0 to 1. The error of linear interpolation between its points is
/// (pi / 1024)^2 / 16, below 1e-6.
using Curve = std::array<float, 1025>;

const Curve& raisedCosine() {
    static const Curve curve = [] {
        Curve points{};
        for (std::size_t i = 0; i < points.size(); ++i) {
            const double progress = static_cast<double>(i) / static_cast<double>(points.size() - 1);
            points[i] = static_cast<float>(0.5 - 0.5 * std::cos(std::numbers::pi * progress));
        }
        return points;
    }();
    return curve;
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

Gate::Gate(double sampleRateHz, double closeSeconds)
    : curve_(raisedCosine()),
      openSamples_(wholeSamples(openSeconds, requireSampleRate(sampleRateHz))),
      closeSamples_(wholeSamples(closeSeconds, sampleRateHz)) {}

void Gate::reset() noexcept {
    position_ = 0;
    opening_ = false;
}

void Gate::openAtOnce() noexcept {
    position_ = fullyOpen();
    opening_ = true;
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
    const auto intervals = static_cast<float>(curve_.size() - 1);
    const float place = static_cast<float>(position_) * intervals / static_cast<float>(full);
    const auto lower = std::min(static_cast<std::size_t>(place), curve_.size() - 2);
    return curve_[lower] + (place - static_cast<float>(lower)) * (curve_[lower + 1] - curve_[lower]);
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
