#include "effects/clip_sound.hpp"

#include "dsp/sample_rates.hpp"

#include <cmath>

namespace haptoflow::effects {
namespace {

constexpr double tailSeconds = 0.0005;

}  // namespace

ClipSound::ClipSound(double sampleRateHz)
    : step_(waveRateHz / dsp::requireOutputRate(sampleRateHz)),
      decay_(static_cast<float>(std::exp(-1.0 / (tailSeconds * sampleRateHz)))) {}

void ClipSound::start(std::span<const float> waveMps2, float gain, bool isLoop) noexcept {
    leave();
    wave_ = waveMps2;
    isLoop_ = isLoop;
    gain_ = std::isfinite(gain) ? gain : 0.0F;
    place_ = 0.0;
}

void ClipSound::leave() noexcept {
    if (!wave_.empty()) {
        tail_ += newest_;
    }
    wave_ = {};
    newest_ = 0.0F;
}

void ClipSound::reset() noexcept {
    wave_ = {};
    newest_ = 0.0F;
    tail_ = 0.0F;
}

float ClipSound::sampleAt(std::ptrdiff_t index) const noexcept {
    const auto count = static_cast<std::ptrdiff_t>(wave_.size());
    if (isLoop_) {
        index = (index % count + count) % count;
    }
    if (index < 0 || index >= count) {
        return 0.0F;
    }
    const float sample = wave_[static_cast<std::size_t>(index)];
    return std::isfinite(sample) ? sample : 0.0F;
}

float ClipSound::next() noexcept {
    const double floor = std::floor(place_);
    const auto index = static_cast<std::ptrdiff_t>(floor);
    const auto share = static_cast<float>(place_ - floor);
    const float before = sampleAt(index - 1);
    const float from = sampleAt(index);
    const float to = sampleAt(index + 1);
    const float after = sampleAt(index + 2);
    // Catmull-Rom.
    const float slope = 0.5F * (to - before);
    const float nextSlope = 0.5F * (after - from);
    const float rise = to - from;
    const float value =
        from +
        share * (slope + share * (3.0F * rise - 2.0F * slope - nextSlope + share * (slope + nextSlope - 2.0F * rise)));
    place_ += step_;
    const auto length = static_cast<double>(wave_.size());
    if (isLoop_ && place_ >= length) {
        place_ = std::fmod(place_, length);
    }
    newest_ = gain_ * value;
    const float played = newest_;
    if (!isLoop_ && place_ >= length) {
        leave();
    }
    return played;
}

void ClipSound::process(std::span<float> samplesMps2) noexcept {
    for (float& sample : samplesMps2) {
        // The tail begins with the sample after the one that it continues.
        tail_ *= decay_;
        sample += tail_;
        if (!wave_.empty()) {
            sample += next();
        }
    }
    if (std::abs(tail_) < static_cast<float>(imperceptibleMps2)) {
        tail_ = 0.0F;
    }
}

}  // namespace haptoflow::effects
