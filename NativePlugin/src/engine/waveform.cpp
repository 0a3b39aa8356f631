#include "engine/waveform.hpp"

#include "dsp/splice.hpp"

#include <algorithm>

namespace haptoflow::engine {
namespace {

constexpr auto segmentLength = static_cast<std::int64_t>(inference::segmentSamples);

}  // namespace

void Waveform::begin(const skeleton::StreamParameters& parameters, double samplesAhead,
                     const skeleton::NoiseKey& key) noexcept {
    stream_.begin(parameters, samplesAhead, key);
    corrections_.fill(0.0F);
    past_.fill(0.0F);
    ownPast_.fill(0.0F);
    beginning_ = correctedFrom_ = correctedUntil_ = head_;
}

std::int64_t Waveform::take(const Correction& correction) noexcept {
    const std::int64_t start = std::max(correction.start, head_);
    const std::int64_t end = correction.start + segmentLength;
    if (start >= end || end - head_ > aheadSamples) {
        return -1;
    }
    std::array<float, dsp::Splice::correlationSamples> replaced{};
    const auto known = static_cast<std::size_t>(
        std::clamp<std::int64_t>(correctedUntil_ - start, 0, static_cast<std::int64_t>(replaced.size())));
    for (std::size_t index = 0; index < replaced.size(); ++index) {
        replaced[index] = correctionAt(start + static_cast<std::int64_t>(index));
    }
    const auto successor = std::span(correction.unit).subspan(static_cast<std::size_t>(start - correction.start));
    dsp::Splice splice;
    splice.begin(std::span(replaced).first(std::max(known, std::min(dsp::Splice::maximumLength, successor.size()))),
                 successor, dsp::Splice::maximumLength);
    for (std::size_t index = 0; index < successor.size(); ++index) {
        float& sample = correctionAt(start + static_cast<std::int64_t>(index));
        sample = splice.active() ? splice.next(replaced[index], successor[index]) : successor[index];
    }
    for (std::int64_t sample = end; sample < correctedUntil_; ++sample) {
        correctionAt(sample) = 0.0F;
    }
    if (head_ >= correctedUntil_) {
        correctedFrom_ = start;
        endGain_ = 1.0F;
    } else if (start > correctedUntil_) {
        fadeBefore(correctedUntil_);
    }
    correctedUntil_ = end;
    return start;
}

void Waveform::fadeBefore(std::int64_t end) noexcept {
    for (std::int64_t sample = std::max(head_, end - fadeSamples); sample < end; ++sample) {
        correctionAt(sample) *= static_cast<float>(end - sample) / static_cast<float>(fadeSamples);
    }
}

float Waveform::nextCorrection() noexcept {
    constexpr float gainStep = 1.0F / static_cast<float>(fadeSamples);
    float& sample = correctionAt(head_);
    const auto left = static_cast<float>(std::clamp<std::int64_t>(correctedUntil_ - head_, 0, fadeSamples));
    endGain_ = std::min(left * gainStep, endGain_ + gainStep);
    const float corrected = sample * endGain_;
    sample = 0.0F;
    return corrected;
}

void Waveform::read(const skeleton::Skeleton* skeleton, std::span<float> waveMps2) noexcept {
    stream_.next(skeleton, waveMps2);
    for (float& sample : waveMps2) {
        const float levelMps2 = stream_.nextRampedLevelMps2();
        const float own = sample * levelMps2;
        sample = own + nextCorrection() * levelMps2;
        past_[static_cast<std::size_t>(head_) % past_.size()] = sample;
        ownPast_[static_cast<std::size_t>(head_) % ownPast_.size()] = own;
        ++head_;
    }
}

void Waveform::copyOut(const Past& past, std::span<float, inference::segmentSamples> out) const noexcept {
    const auto oldest = static_cast<std::size_t>(head_) % past.size();
    const auto next = std::copy(past.begin() + static_cast<std::ptrdiff_t>(oldest), past.end(), out.begin());
    std::copy_n(past.begin(), oldest, next);
}

}  // namespace haptoflow::engine
