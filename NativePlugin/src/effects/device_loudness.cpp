#include "effects/device_loudness.hpp"

#include "dsp/sample_rates.hpp"
#include "effects/perceived_intensity.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

namespace haptoflow::effects {
namespace {

constexpr double stepsPerSecond = 2000.0;
// exp(-0.5 ms / 20 ms)
constexpr float releasePerStep = 0.9753F;
// Larger than in any real wave; keeps products finite.
constexpr float largest = 1e6F;

std::size_t stepOf(double sampleRateHz) {
    if (!(sampleRateHz >= 2000.0 && sampleRateHz <= 192000.0)) {
        throw std::invalid_argument("envelope gain: the rate is " + std::to_string(sampleRateHz) +
                                    " Hz; expected 2000 to 192000");
    }
    return static_cast<std::size_t>(std::ceil(sampleRateHz / stepsPerSecond));
}

}  // namespace

EnvelopeGain::EnvelopeGain(double sampleRateHz, Law law) : law_(law), stepSamples_(stepOf(sampleRateHz)) {
    reset();
}

void EnvelopeGain::reset() noexcept {
    begin(0.0F);
}

void EnvelopeGain::begin(float envelope) noexcept {
    delayed_.fill(0.0F);
    peaks_.fill(0.0F);
    place_ = 0;
    peakPlace_ = 0;
    inStep_ = 0;
    peak_ = 0.0F;
    envelope_ = envelope;
    newestGain_ = law_(envelope);
    gainFrom_ = newestGain_;
    gainTo_ = newestGain_;
    silentSteps_ = delaySteps + 1;
}

void EnvelopeGain::process(std::span<float> samples) noexcept {
    for (float& sample : samples) {
        const float taken = std::isfinite(sample) ? std::clamp(sample, -largest, largest) : 0.0F;
        const float share = static_cast<float>(inStep_) / static_cast<float>(stepSamples_);
        sample = delayed_[place_] * (gainFrom_ + share * (gainTo_ - gainFrom_));
        delayed_[place_] = taken;
        place_ = (place_ + 1) % (delaySteps * stepSamples_);
        peak_ = std::max(peak_, std::abs(taken));
        if (peak_ > 0.0F) {
            silentSteps_ = 0;
        }
        if (++inStep_ == stepSamples_) {
            finishStep();
        }
    }
}

void EnvelopeGain::finishStep() noexcept {
    silentSteps_ += silentSteps_ <= delaySteps ? 1 : 0;
    peaks_[peakPlace_] = peak_;
    peakPlace_ = (peakPlace_ + 1) % holdSteps;
    envelope_ = std::max(*std::ranges::max_element(peaks_), releasePerStep * envelope_);
    const float gain = law_(envelope_);
    gainFrom_ = gainTo_;
    gainTo_ = std::min(newestGain_, gain);
    newestGain_ = gain;
    peak_ = 0.0F;
    inStep_ = 0;
}

namespace {

constexpr double shelfStartHz = 150.0;
constexpr double shelfEndHz = 1500.0;
// Envelope of the brightened wave in m/s^2 that is played at this share of the full scale, and the slope around it.
// scripts/pack/device_levels.py prints the levels that result.
constexpr float middleEnvelopeMps2 = 12.0F;
constexpr float listenShare = 0.4F;
constexpr float exponent = 0.4F;
constexpr float softKnee = 0.7F;
constexpr float ceiling = 0.9F;
// Quieter envelopes are not raised any further.
constexpr float leastEnvelopeMps2 = 0.2F;
constexpr float largestMps2 = 1e6F;
// Near the gain of 1, from which Listen opens when it is switched on while something sounds.
constexpr float loudEnvelopeMps2 = 200.0F;

float shareOf(float envelopeMps2) noexcept {
    const float share = listenShare * std::pow(envelopeMps2 / middleEnvelopeMps2, exponent);
    constexpr float room = ceiling - softKnee;
    return share <= softKnee ? share : ceiling - room * room / (room + share - softKnee);
}

float gainOf(float envelopeMps2) noexcept {
    const float envelope = std::max(envelopeMps2, leastEnvelopeMps2);
    return shareOf(envelope) / envelope;
}

}  // namespace

// A first-order shelf (1 + s / w1) / (1 + s / w2) by the bilinear transform, with both corners prewarped.
Listen::Listen(double sampleRateHz, double fullScaleMps2)
    : fullScaleMps2_(static_cast<float>(fullScaleMps2)), gain_(dsp::requireOutputRate(sampleRateHz), gainOf) {
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

EnvelopeGain deviceWave(double sampleRateHz) {
    return {sampleRateHz, waveGain};
}

}  // namespace haptoflow::effects
