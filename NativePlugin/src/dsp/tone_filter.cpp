#include "dsp/tone_filter.hpp"

#include <algorithm>

namespace haptoflow::dsp {
namespace {

constexpr ToneKernel plain = [] {
    ToneKernel kernel{};
    kernel[0] = 1.0F;
    return kernel;
}();

const ToneKernel& orPlain(const ToneKernel* kernel) noexcept {
    return kernel == nullptr ? plain : *kernel;
}

float shareLeft(std::size_t fadeLeft) noexcept {
    return static_cast<float>(fadeLeft) / static_cast<float>(ToneFilter::fadeSamples);
}

}  // namespace

bool ToneFilter::isHeadingFor(const ToneKernel* kernel) const noexcept {
    return hasTone_ == (kernel != nullptr) && (kernel == nullptr || to_ == *kernel);
}

void ToneFilter::setTone(const ToneKernel* kernel, std::span<const float, memorySamples> past) noexcept {
    if (isHeadingFor(kernel)) {
        return;
    }
    if (!active_) {
        from_ = plain;
        std::ranges::reverse_copy(past, memory_.begin());
        active_ = true;
    } else {
        // From where it is now, however far the last change has come.
        const float left = shareLeft(fadeLeft_);
        for (std::size_t tap = 0; tap < toneTaps; ++tap) {
            from_[tap] = to_[tap] + left * (from_[tap] - to_[tap]);
        }
    }
    hasTone_ = kernel != nullptr;
    to_ = orPlain(kernel);
    fadeLeft_ = fadeSamples;
}

void ToneFilter::reset(const ToneKernel* kernel) noexcept {
    hasTone_ = kernel != nullptr;
    active_ = hasTone_;
    to_ = orPlain(kernel);
    fadeLeft_ = 0;
    memory_.fill(0.0F);
}

void ToneFilter::settle() noexcept {
    if (fadeLeft_ > 0) {
        --fadeLeft_;
    }
    active_ = hasTone_ || fadeLeft_ > 0;
}

void ToneFilter::process(std::span<float> samples) noexcept {
    for (float& sample : samples) {
        if (!active_) {
            return;
        }
        float heard = to_[0] * sample;
        float before = from_[0] * sample;
        for (std::size_t tap = 0; tap < memorySamples; ++tap) {
            heard += to_[tap + 1] * memory_[tap];
            before += from_[tap + 1] * memory_[tap];
        }
        std::ranges::copy_backward(std::span(memory_).first(memorySamples - 1), memory_.end());
        memory_[0] = sample;
        sample = fadeLeft_ > 0 ? heard + shareLeft(fadeLeft_) * (before - heard) : heard;
        settle();
    }
}

}  // namespace haptoflow::dsp
