#include "effects/envelope_gain.hpp"

#include <algorithm>
#include <cmath>
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

}  // namespace haptoflow::effects
