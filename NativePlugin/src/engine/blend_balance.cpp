#include "engine/blend_balance.hpp"

#include "engine/surface_phases.hpp"
#include "inference/gaussian_noise.hpp"
#include "skeleton/condition.hpp"

#include <algorithm>
#include <cmath>

namespace haptoflow::engine {
namespace {

// Averaging time that gives the level of a random texture within a few tenths of a decibel.
constexpr double memorySeconds = 2.0;
// Initial weight of the assumption that the level is right.
constexpr double priorSeconds = 0.1;
constexpr double maximumLogGain = 0.7;
// Noise keys above those of the voice's own segments, which count from 0.
constexpr std::uint64_t firstSegment = std::uint64_t{1} << 63U;

double meanSquare(std::span<const float> samples) noexcept {
    double sum = 0.0;
    for (const float sample : samples) {
        sum += static_cast<double>(sample) * static_cast<double>(sample);
    }
    return sum / static_cast<double>(samples.size());
}

double secondsOf(std::int64_t samples) noexcept {
    return static_cast<double>(samples) / inference::waveformRateHz;
}

}  // namespace

void BlendBalance::RunningPower::add(double power, double seconds) noexcept {
    if (!std::isfinite(power) || !(seconds > 0.0)) {
        return;
    }
    seconds_ = std::min(seconds_ + seconds, memorySeconds);
    mean_ += (power - mean_) * std::min(1.0, seconds / (seconds_ + priorSeconds));
}

double BlendBalance::RunningPower::logarithm() const noexcept {
    return std::log(std::max(mean_, 1e-6));
}

BlendBalance::Shadow BlendBalance::shadowOf(const BlendParts::Part& part) const noexcept {
    const auto known = std::span(shadows_).first(count_);
    const auto found = std::ranges::find(known, part.embedding, [](const Shadow& each) { return each.part.embedding; });
    Shadow shadow = found == known.end() ? Shadow{} : *found;
    shadow.part = part;
    return shadow;
}

void BlendBalance::follow(const BlendParts& blend, const std::array<float, 3>& motion, std::int64_t sample) noexcept {
    if (blend.count == 0) {
        count_ = 0;
        return;
    }
    if (count_ == 0) {
        blend_ = {};
        lastStep_ = sample - stepSamples;
        lastLevelled_ = sample;
    }
    motion_ = motion;
    sample_ = sample;
    std::array<Shadow, BlendParts::capacity> shadows{};
    std::ranges::transform(blend.all(), shadows.begin(), [this](const auto& part) { return shadowOf(part); });
    shadows_ = shadows;
    count_ = blend.count;
}

void BlendBalance::request(std::vector<inference::SegmentRequest>& requests) {
    requested_ = 0;
    if (count_ == 0 || sample_ < lastStep_ + stepSamples) {
        return;
    }
    lastStep_ = sample_;
    for (Shadow& shadow : std::span(shadows_).first(count_)) {
        const inference::NoiseKey key{.seed = seed_, .voice = voice_, .segment = firstSegment + segments_};
        ++segments_;
        inference::fillStandardNormal(key, shadow.noise);
        inference::SegmentRequest request{
            .embedding = shadow.part.embedding, .motion = motion_, .previous = shadow.previous, .noise = shadow.noise};
        request.phases = skeleton::phasesOf(request.embedding, motion_, toNetwork(shadow.phase));
        setSlips(request.phases, shadow.slipPhase, slipsPerSample(shadow.part.slip, motion_, 0.0));
        request.impulseGain = shadow.part.impulseGain;
        request.levelMps2 = 1.0F;
        requests.push_back(request);
        ++requested_;
    }
}

void BlendBalance::take(std::span<const float> segments) noexcept {
    constexpr auto step = static_cast<std::size_t>(stepSamples);
    for (std::size_t i = 0; i < requested_; ++i) {
        Shadow& shadow = shadows_[i];
        const auto segment = segments.subspan(i * inference::segmentSamples, inference::segmentSamples);
        shadow.power.add(meanSquare(segment), secondsOf(stepSamples));
        std::shift_left(shadow.previous.begin(), shadow.previous.end(), stepSamples);
        std::ranges::copy(segment.first(step), shadow.previous.end() - stepSamples);
        const RibCycles cycles = ribCyclesPerSample(shadow.part.embedding, motion_[0], motion_[1]);
        for (std::size_t rib = 0; rib < cycles.size(); ++rib) {
            const double phase = shadow.phase[rib] + cycles[rib] * static_cast<double>(stepSamples);
            shadow.phase[rib] = phase - std::floor(phase);
        }
        const double slipped =
            shadow.slipPhase + slipsPerSample(shadow.part.slip, motion_, 0.0) * static_cast<double>(stepSamples);
        shadow.slipPhase = slipped - std::floor(slipped);
    }
    requested_ = 0;
}

float BlendBalance::gain() const noexcept {
    double target = 0.0;
    for (const Shadow& shadow : std::span(shadows_).first(count_)) {
        target += static_cast<double>(shadow.part.share) * shadow.power.logarithm();
    }
    return static_cast<float>(
        std::exp(std::clamp(0.5 * (target - blend_.logarithm()), -maximumLogGain, maximumLogGain)));
}

float BlendBalance::level(std::span<float, inference::segmentSamples> segmentMps2, float levelMps2) noexcept {
    if (count_ == 0 || !(levelMps2 > 0.0F)) {
        return 1.0F;
    }
    const double power = meanSquare(segmentMps2) / (static_cast<double>(levelMps2) * static_cast<double>(levelMps2));
    blend_.add(power, secondsOf(std::clamp<std::int64_t>(sample_ - lastLevelled_, 0, stepSamples)));
    lastLevelled_ = sample_;
    const float factor = gain();
    std::ranges::for_each(segmentMps2, [factor](float& sample) { sample *= factor; });
    return factor;
}

}  // namespace haptoflow::engine
