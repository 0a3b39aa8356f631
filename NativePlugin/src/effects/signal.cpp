#include "effects/signal.hpp"

#include <cmath>
#include <numbers>

namespace haptoflow::effects {

Signal::Signal(double sampleRateHz)
    : sampleRateHz_(sampleRateHz), gate_(sampleRateHz, rampSeconds), amplitudeMps2_(sampleRateHz, 0.01, 0.0F) {}

void Signal::set(const SignalSettings& settings) noexcept {
    if (!settings.isSet()) {
        return;
    }
    if (isIdle()) {
        amplitudeMps2_.reset(settings.amplitudeMps2);
    } else {
        amplitudeMps2_.setTarget(settings.amplitudeMps2);
    }
    if (settings.frequencyHz != frequencyHz_) {
        frequencyHz_ = settings.frequencyHz;
        const double turn = 2.0 * std::numbers::pi * static_cast<double>(frequencyHz_) / sampleRateHz_;
        turnCosine_ = std::cos(turn);
        turnSine_ = std::sin(turn);
    }
}

void Signal::begin() noexcept {
    if (isIdle()) {
        cosine_ = 1.0;
        sine_ = 0.0;
    }
    gate_.open();
}

void Signal::process(std::span<float> samplesMps2) noexcept {
    for (float& sample : samplesMps2) {
        const float amplitudeMps2 = gate_.nextGain() * amplitudeMps2_.next();
        sample += amplitudeMps2 * static_cast<float>(sine_);
        const double cosine = cosine_ * turnCosine_ - sine_ * turnSine_;
        sine_ = cosine_ * turnSine_ + sine_ * turnCosine_;
        cosine_ = cosine;
    }
    // One step of Newton's method corrects the radius, which drifts by rounding.
    const double back = 1.5 - 0.5 * (cosine_ * cosine_ + sine_ * sine_);
    cosine_ *= back;
    sine_ *= back;
}

void Signal::reset() noexcept {
    gate_.reset();
    amplitudeMps2_.reset(amplitudeMps2_.target());
}

}  // namespace haptoflow::effects
