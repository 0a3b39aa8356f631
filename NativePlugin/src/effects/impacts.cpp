#include "effects/impacts.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace haptoflow::effects {

void DecayingSinusoid::start(double frequencyHz, double decayPerSecond, double amplitudeMps2,
                             double sampleRateHz) noexcept {
    stop();
    const bool isAudible = frequencyHz > 0.0 && frequencyHz <= 0.45 * sampleRateHz && decayPerSecond > 0.0 &&
                           std::isfinite(decayPerSecond) && amplitudeMps2 > 0.0 && std::isfinite(amplitudeMps2);
    if (!isAudible) {
        return;
    }
    const double turn = 2.0 * std::numbers::pi * frequencyHz / sampleRateHz;
    decay_ = std::exp(-decayPerSecond / sampleRateHz);
    feedback_ = 2.0 * decay_ * std::cos(turn);
    damping_ = decay_ * decay_;
    // The two past values of the same sinusoid, so that the next sample is its zero crossing.
    newest_ = -amplitudeMps2 * std::sin(turn) / decay_;
    previous_ = -amplitudeMps2 * std::sin(2.0 * turn) / damping_;
    envelopeMps2_ = amplitudeMps2;
}

void DecayingSinusoid::addTo(std::span<float> samplesMps2) noexcept {
    if (isIdle()) {
        return;
    }
    for (float& sample : samplesMps2) {
        const double value = feedback_ * newest_ - damping_ * previous_;
        previous_ = newest_;
        newest_ = value;
        envelopeMps2_ *= decay_;
        sample += static_cast<float>(value);
    }
    if (isIdle()) {
        stop();
    }
}

namespace {

// Acceleration that returns a rebounding tip to the surface. It exceeds gravity because the hand presses the stylus.
constexpr double returnAccelerationMps2 = 25.0;
// The minimum decay that a model file may state, and the maximum amplitude of a mode.
constexpr double minimumDecayPerSecond = 10.0;
constexpr double maximumAmplitudeMps2 = 1e5;

}  // namespace

Impacts::Impacts(double sampleRateHz, double decayFactor) noexcept
    : sampleRateHz_(sampleRateHz), decayFactor_(decayFactor) {}

void Impacts::start(double speedMps, const ImpactResponse& response) noexcept {
    if (!(speedMps > 0.0)) {
        return;
    }
    const double speed = std::min(speedMps, maximumEventMps);
    ring(speed, response);
    // A weaker landing than the expected rebound, such as a flicker of the contact, does not replace that rebound.
    if (speed >= rebound_.speedMps) {
        reboundsLeft_ = rebounds;
        planRebound(speed, response);
    }
}

void Impacts::ring(double speedMps, const ImpactResponse& response) noexcept {
    for (const ImpactResponse::Mode& mode : response.modes) {
        const double amplitude = std::min(static_cast<double>(mode.gainPerSecond) * speedMps, maximumAmplitudeMps2);
        const double decay = std::max(static_cast<double>(mode.decayPerSecond), minimumDecayPerSecond) * decayFactor_;
        const auto quietest = std::ranges::min_element(ringing_, {}, &DecayingSinusoid::envelopeMps2);
        if (amplitude > quietest->envelopeMps2()) {
            quietest->start(mode.frequencyHz, decay, amplitude, sampleRateHz_);
            isIdle_ = false;
        }
    }
}

void Impacts::planRebound(double speedMps, const ImpactResponse& response) noexcept {
    rebound_ = {};
    const double restitution =
        std::clamp(static_cast<double>(response.restitution), 0.0, ImpactResponse::maximumRestitution);
    if (reboundsLeft_ == 0 || !(restitution > 0.0)) {
        reboundsLeft_ = 0;
        return;
    }
    --reboundsLeft_;
    rebound_.speedMps = restitution * speedMps;
    rebound_.response = response;
    const double flightSeconds = 2.0 * rebound_.speedMps / returnAccelerationMps2;
    rebound_.samplesLeft = 1 + static_cast<std::uint64_t>(flightSeconds * sampleRateHz_);
    isIdle_ = false;
}

void Impacts::process(std::span<float> samplesMps2) noexcept {
    while (!samplesMps2.empty()) {
        const bool isDue = rebound_.samplesLeft > 0;
        const std::size_t until =
            isDue ? static_cast<std::size_t>(std::min<std::uint64_t>(rebound_.samplesLeft, samplesMps2.size()))
                  : samplesMps2.size();
        for (DecayingSinusoid& sinusoid : ringing_) {
            sinusoid.addTo(samplesMps2.first(until));
        }
        samplesMps2 = samplesMps2.subspan(until);
        rebound_.samplesLeft -= isDue ? until : 0;
        if (isDue && rebound_.samplesLeft == 0) {
            const Rebound landed = rebound_;
            ring(landed.speedMps, landed.response);
            planRebound(landed.speedMps, landed.response);
        }
    }
    isIdle_ = rebound_.samplesLeft == 0 && std::ranges::all_of(ringing_, &DecayingSinusoid::isIdle);
}

void Impacts::reset() noexcept {
    for (DecayingSinusoid& sinusoid : ringing_) {
        sinusoid.stop();
    }
    rebound_ = {};
    reboundsLeft_ = 0;
    isIdle_ = true;
}

}  // namespace haptoflow::effects
