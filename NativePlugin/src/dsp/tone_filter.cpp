#include "dsp/tone_filter.hpp"

#include <algorithm>

namespace haptoflow::dsp {
namespace {

constexpr ToneKernel unitImpulse = [] {
    ToneKernel kernel{};
    kernel[0] = 1.0F;
    return kernel;
}();

const ToneKernel& orUnitImpulse(const ToneKernel* kernel) noexcept {
    return kernel == nullptr ? unitImpulse : *kernel;
}

float remainingShare(std::size_t fadeLeft) noexcept {
    return static_cast<float>(fadeLeft) / static_cast<float>(ToneFilter::fadeSamples);
}

}  // namespace

bool ToneFilter::isTarget(const ToneKernel* kernel) const noexcept {
    return hasTone_ == (kernel != nullptr) && (kernel == nullptr || to_ == *kernel);
}

void ToneFilter::setTone(const ToneKernel* kernel, std::span<const float, memorySamples> past) noexcept {
    if (isTarget(kernel)) {
        return;
    }
    if (!active_) {
        from_ = unitImpulse;
        std::ranges::reverse_copy(past, memory_.begin());
        active_ = true;
    } else {
        // Start from the present kernel, which may be in the middle of an earlier change.
        const float left = remainingShare(fadeRemaining_);
        for (std::size_t tap = 0; tap < toneTaps; ++tap) {
            from_[tap] = to_[tap] + left * (from_[tap] - to_[tap]);
        }
    }
    hasTone_ = kernel != nullptr;
    to_ = orUnitImpulse(kernel);
    fadeRemaining_ = fadeSamples;
}

void ToneFilter::reset(const ToneKernel* kernel) noexcept {
    hasTone_ = kernel != nullptr;
    active_ = hasTone_;
    to_ = orUnitImpulse(kernel);
    fadeRemaining_ = 0;
    memory_.fill(0.0F);
}

void ToneFilter::settle() noexcept {
    if (fadeRemaining_ > 0) {
        --fadeRemaining_;
    }
    active_ = hasTone_ || fadeRemaining_ > 0;
}

void ToneFilter::process(std::span<float> samples) noexcept {
    for (float& sample : samples) {
        if (!active_) {
            return;
        }
        float target = to_[0] * sample;
        float before = from_[0] * sample;
        for (std::size_t tap = 0; tap < memorySamples; ++tap) {
            target += to_[tap + 1] * memory_[tap];
            before += from_[tap + 1] * memory_[tap];
        }
        std::ranges::copy_backward(std::span(memory_).first(memorySamples - 1), memory_.end());
        memory_[0] = sample;
        sample = fadeRemaining_ > 0 ? target + remainingShare(fadeRemaining_) * (before - target) : target;
        settle();
    }
}

}  // namespace haptoflow::dsp
