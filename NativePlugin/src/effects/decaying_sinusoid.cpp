#include "effects/decaying_sinusoid.hpp"

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

}  // namespace haptoflow::effects
