#include "skeleton/synthesis.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

namespace haptoflow::skeleton {
namespace {

constexpr float largestSwing = 2.0F;

}  // namespace

void Synthesis::begin(const ReflectionFilter& filter, std::span<const float, filterOrder> noise) noexcept {
    past_ = filter.stationaryPast(noise);
    limitPast();
    ringing_ = {};
}

void Synthesis::begin(std::span<const float, filterOrder> past) noexcept {
    std::ranges::copy(past, past_.begin());
    ringing_ = {};
}

void Synthesis::limitPast() noexcept {
    constexpr auto limit = static_cast<double>(skeletonLimit);
    double largest = 0.0;
    for (double& sample : past_) {
        sample = std::isnan(sample) ? 0.0 : std::clamp(sample, -1e100, 1e100);
        largest = std::max(largest, std::fabs(sample));
    }
    if (largest > limit) {
        std::ranges::for_each(past_, [scale = limit / largest](double& sample) { sample *= scale; });
    }
}

bool Synthesis::fits(const ReflectionFilter& before, const ReflectionFilter& now) const noexcept {
    const auto energyOf = [this](const ReflectionFilter& filter) {
        const auto rung = ringOut(filter);
        return std::inner_product(rung.begin(), rung.end(), rung.begin(), 0.0F);
    };
    return energyOf(now) <= 2.0F * energyOf(before) + 0.5F * static_cast<float>(ringOutSamples);
}

void Synthesis::replace(const ReflectionFilter& before, const ReflectionFilter& now,
                        std::span<const float, filterOrder> noise) noexcept {
    std::copy_n(ringOut(before).begin(), leavingSamples, leaving_.begin());
    leavingLeft_ = leavingSamples;
    begin(now, noise);
}

std::array<float, Synthesis::ringOutSamples> Synthesis::ringOut(const ReflectionFilter& filter) const noexcept {
    constexpr std::array<float, ringOutSamples> nothing{};
    std::array<float, ringOutSamples> rung{};
    std::array<double, filterOrder> past = past_;
    filter.run(past, nothing, rung);
    return rung;
}

void Synthesis::spliceInto(std::span<float> unit) noexcept {
    for (float& sample : unit.first(std::min(unit.size(), leavingLeft_))) {
        const float left = static_cast<float>(leavingLeft_) / static_cast<float>(leavingSamples + 1);
        const float come = 1.0F - left;
        const float mixed = left * leaving_[leavingSamples - leavingLeft_] + come * sample;
        sample = limitedOrZero(mixed / std::sqrt(left * left + come * come), skeletonLimit);
        --leavingLeft_;
    }
}

void Synthesis::next(const TailImpulses& tails, const SkeletonParameters& parameters,
                     const std::array<FamilyPhase, familyCount>& phases, std::span<const float> noise,
                     std::span<float> unit, NetworkView view) noexcept {
    const std::size_t samples = noise.size();
    SurfaceWaves waves(samples);
    if (view.input != nullptr) {
        for (std::size_t channel = 2; channel < NetworkInput::channels; ++channel) {
            std::ranges::fill(view.input->piece(channel, view.first, samples), 0.0F);
        }
    }
    for (std::size_t family = 0; family < familyCount; ++family) {
        if (isHeardHz(phases[family].rateHz) && std::isfinite(phases[family].cycles)) {
            waves.add(phases[family], parameters.families[family], view);
        }
    }
    Piece limited{};
    std::ranges::transform(noise, limited.begin(), [](float sample) { return limitedOrZero(sample, noiseLimit); });
    tails.add(std::span(limited).first(samples), parameters.impulseGains, ringing_);

    const auto gain = static_cast<float>(std::exp(parameters.filter.logGain));
    Piece drive{};
    for (std::size_t n = 0; n < samples; ++n) {
        float driven = limited[n];
        if (waves.isHeard()) {
            driven = driven * std::exp(largestSwing * std::tanh(waves.swing()[n] / largestSwing)) + waves.lines()[n];
        }
        drive[n] = gain * (driven + ringing_[n]);
    }
    parameters.filter.run(past_, std::span(drive).first(samples), unit);
    spliceInto(unit);
    if (view.input != nullptr) {
        std::ranges::copy(unit, view.input->piece(0, view.first, samples).begin());
        std::ranges::transform(std::span(ringing_).first(samples), view.input->piece(1, view.first, samples).begin(),
                               [gain](float impulse) { return gain * impulse; });
    }
    std::shift_left(ringing_.begin(), ringing_.end(), static_cast<std::ptrdiff_t>(samples));
    std::fill_n(ringing_.end() - static_cast<std::ptrdiff_t>(samples), samples, 0.0F);
}

NetworkInput synthesiseSegment(const Skeleton& skeleton, const SkeletonParameters& parameters,
                               const SegmentStart& start) noexcept {
    NetworkInput input;
    Synthesis synthesis;
    synthesis.begin(start.previous.last<filterOrder>());
    std::array<FamilyPhase, familyCount> phases{};
    for (std::size_t first = 0; first < segmentSamples; first += pieceSamples) {
        const std::size_t samples = std::min(pieceSamples, segmentSamples - first);
        for (std::size_t family = 0; family < familyCount; ++family) {
            const auto rateHz = static_cast<double>(start.phases[familyCount + family]);
            phases[family] = {.cycles = static_cast<double>(start.phases[family]) +
                                        rateHz * static_cast<double>(first) / waveformRateHz,
                              .rateHz = rateHz};
        }
        Piece unit{};
        synthesis.next(skeleton.impulses(), parameters, phases, start.noise.subspan(first, samples),
                       std::span(unit).first(samples), {.input = &input, .first = first});
    }
    return input;
}

}  // namespace haptoflow::skeleton
