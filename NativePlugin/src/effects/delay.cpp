#include "effects/delay.hpp"

#include "dsp/sample_rates.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

namespace haptoflow::effects {

Delay::Delay(double sampleRateHz)
    : sampleRateHz_(dsp::requireOutputRate(sampleRateHz)),
      maximumSamples_(static_cast<std::size_t>(std::llround(maximumSeconds * sampleRateHz))),
      line_(std::bit_ceil(maximumSamples_ + 1), 0.0F),
      fade_(static_cast<std::size_t>(std::lround(fadeSeconds * sampleRateHz))),
      silent_(maximumSamples_ + 1),
      faded_(fade_.size()) {
    for (std::size_t i = 0; i < fade_.size(); ++i) {
        const double share = static_cast<double>(i + 1) / static_cast<double>(fade_.size());
        fade_[i] = static_cast<float>(0.5 - 0.5 * std::cos(std::numbers::pi * share));
    }
}

void Delay::setDelaySeconds(double seconds) noexcept {
    if (std::isnan(seconds)) {
        return;
    }
    const double within = std::clamp(seconds, 0.0, maximumSeconds);
    requested_ = std::min(maximumSamples_, static_cast<std::size_t>(std::llround(within * sampleRateHz_)));
    if (isIdle()) {
        current_ = requested_;
        faded_ = fade_.size();
    }
}

double Delay::delaySeconds() const noexcept {
    return static_cast<double>(requested_) / sampleRateHz_;
}

void Delay::write(float sample) noexcept {
    newest_ = (newest_ + 1) & (line_.size() - 1);
    line_[newest_] = sample;
    held_ = std::min(held_ + 1, maximumSamples_ + 1);
    silent_ = sample == 0.0F ? std::min(silent_ + 1, maximumSamples_ + 1) : 0;
}

// Samples written before the last reset are still in memory but must not be read.
float Delay::tap(std::size_t delaySamples) const noexcept {
    return delaySamples < held_ ? line_[(newest_ - delaySamples) & (line_.size() - 1)] : 0.0F;
}

void Delay::startFadeIfRequested() noexcept {
    if (faded_ == fade_.size() && requested_ != current_) {
        previous_ = current_;
        current_ = requested_;
        faded_ = 0;
    }
}

float Delay::nextFadeSample() noexcept {
    const float weight = fade_[faded_];
    const float out = weight * tap(current_) + (1.0F - weight) * tap(previous_);
    ++faded_;
    return out;
}

void Delay::process(std::span<float> samplesMps2) noexcept {
    for (float& sample : samplesMps2) {
        startFadeIfRequested();
        write(std::isfinite(sample) ? sample : 0.0F);
        sample = faded_ < fade_.size() ? nextFadeSample() : tap(current_);
    }
}

void Delay::reset() noexcept {
    held_ = 0;
    silent_ = maximumSamples_ + 1;
    current_ = requested_;
    faded_ = fade_.size();
}

bool Delay::isIdle() const noexcept {
    return silent_ > maximumSamples_;
}

}  // namespace haptoflow::effects
