#include "effects/device_loudness.hpp"

#include "effects/perceived_intensity.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace haptoflow::effects {
namespace {

struct Fit {
    double middleMps2;
    double exponent;
};

// Printed by scripts/pack/device_levels.py for the shipped model.
constexpr std::array<Fit, deviceKinds> fits{{
    {3.15, 0.41},   // motor
    {2.13, 0.375},  // parametric
    {2.85, 0.355},  // waveform
}};

constexpr double referenceHz = 160.0;
constexpr double knee = 0.7;

double straightShare(const Fit& fit, double amplitudeMps2) noexcept {
    return middleShare * std::pow(amplitudeMps2 / fit.middleMps2, fit.exponent);
}

double shareOf(DeviceKind kind, double amplitudeMps2) noexcept {
    const Fit& fit = fits[static_cast<std::size_t>(kind)];
    const double thresholdMps2 = detectionThresholdMps2(referenceHz);
    if (amplitudeMps2 < thresholdMps2) {
        return straightShare(fit, thresholdMps2) * amplitudeMps2 / thresholdMps2;
    }
    const double share = straightShare(fit, amplitudeMps2);
    constexpr double room = 1.0 - knee;
    // The limiter's curve: slope 1 at the knee, asymptote 1.
    return share <= knee ? share : 1.0 - room * room / (room + share - knee);
}

float waveGain(float envelopeMps2) noexcept {
    const auto atLeast = static_cast<float>(detectionThresholdMps2(referenceHz));
    const float envelope = std::max(envelopeMps2, atLeast);
    return deviceShare(DeviceKind::waveform, envelope) / envelope;
}

}  // namespace

float deviceShare(DeviceKind kind, float amplitudeMps2) noexcept {
    if (!(amplitudeMps2 > 0.0F)) {
        return 0.0F;
    }
    const double share = shareOf(kind, static_cast<double>(amplitudeMps2));
    return std::min(static_cast<float>(share), std::nextafter(1.0F, 0.0F));
}

DeviceWave::DeviceWave(double sampleRateHz) : gain_(sampleRateHz, waveGain) {}

}  // namespace haptoflow::effects
