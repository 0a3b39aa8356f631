#include "effects/listen.hpp"

#include "dsp/sample_rates.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace haptoflow::effects {
namespace {

constexpr double shelfStartHz = 150.0;
constexpr double shelfEndHz = 1500.0;
// Envelope of the brightened wave in m/s^2 that is played at this share of the full scale, and the slope around it.
// scripts/pack/device_levels.py prints the levels that result.
constexpr float middleEnvelopeMps2 = 12.0F;
constexpr float middleShare = 0.4F;
constexpr float exponent = 0.4F;
constexpr float knee = 0.7F;
constexpr float ceiling = 0.9F;
// Quieter envelopes are not raised any further.
constexpr float leastEnvelopeMps2 = 0.2F;
constexpr float largestMps2 = 1e6F;
// Near the gain of 1, from which Listen opens when it is switched on while something sounds.
constexpr float loudEnvelopeMps2 = 200.0F;

float shareOf(float envelopeMps2) noexcept {
    const float share = middleShare * std::pow(envelopeMps2 / middleEnvelopeMps2, exponent);
    constexpr float room = ceiling - knee;
    return share <= knee ? share : ceiling - room * room / (room + share - knee);
}

float gainOf(float envelopeMps2) noexcept {
    const float envelope = std::max(envelopeMps2, leastEnvelopeMps2);
    return shareOf(envelope) / envelope;
}

}  // namespace

// A first-order shelf (1 + s / w1) / (1 + s / w2) by the bilinear transform, with both corners prewarped.
Listen::Listen(double sampleRateHz, double fullScaleMps2)
    : fullScaleMps2_(static_cast<float>(fullScaleMps2)), gain_(sampleRateHz, gainOf) {
    if (!dsp::isOutputRate(sampleRateHz)) {
        throw std::invalid_argument("listen: expected a rate of 8 to 192 kHz");
    }
    if (!(std::isfinite(fullScaleMps2) && fullScaleMps2 > 0.0)) {
        throw std::invalid_argument("listen: expected a full scale above 0");
    }
    const double start = std::tan(std::numbers::pi * shelfStartHz / sampleRateHz);
    const double end = std::tan(std::numbers::pi * shelfEndHz / sampleRateHz);
    const double ratio = end / start;
    in0_ = ratio * (1.0 + start) / (1.0 + end);
    in1_ = -ratio * (1.0 - start) / (1.0 + end);
    back_ = (1.0 - end) / (1.0 + end);
    gain_.begin(loudEnvelopeMps2);
}

EffectDeclaration Listen::declaration() const noexcept {
    return {.kind = EffectKind::listen,
            .latencySeconds = EnvelopeGain::latencySeconds,
            .tailSeconds = 0.02,
            .memoryBytes = sizeof(*this)};
}

double Listen::brightened(double sample) noexcept {
    for (Shelf& shelf : shelves_) {
        const double out = in0_ * sample + in1_ * shelf.in + back_ * shelf.out;
        shelf = {sample, std::abs(out) < 1e-9 ? 0.0 : out};
        sample = shelf.out;
    }
    return sample;
}

void Listen::process(std::span<float> samplesMps2) noexcept {
    for (float& sample : samplesMps2) {
        const float taken = std::isfinite(sample) ? std::clamp(sample, -largestMps2, largestMps2) : 0.0F;
        sample = static_cast<float>(brightened(static_cast<double>(taken)));
    }
    gain_.process(samplesMps2);
    for (float& sample : samplesMps2) {
        sample *= fullScaleMps2_;
    }
}

void Listen::reset() noexcept {
    shelves_ = {};
    gain_.reset();
}

bool Listen::isIdle() const noexcept {
    const auto isSilent = [](const Shelf& shelf) { return shelf.in == 0.0 && shelf.out == 0.0; };
    return std::ranges::all_of(shelves_, isSilent) && gain_.isIdle();
}

}  // namespace haptoflow::effects
