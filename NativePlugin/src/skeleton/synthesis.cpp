#include "skeleton/synthesis.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace haptoflow::skeleton {
namespace {

constexpr float largestSwing = 2.0F;
// What rings on may not rise beyond this where the level falls far.
constexpr float largestRinging = 64.0F;

}  // namespace

void Synthesis::begin(const ReflectionFilter& filter, std::span<const float, filterOrder> noise) noexcept {
    past_ = filter.stationaryPast(noise);
    rescale(1.0F);
    ringing_ = {};
}

void Synthesis::begin(std::span<const float, filterOrder> past) noexcept {
    std::ranges::copy(past, past_.begin());
    ringing_ = {};
}

void Synthesis::rescale(float factor) noexcept {
    constexpr auto limit = static_cast<double>(unitLimit);
    for (double& sample : past_) {
        const double scaled = sample * static_cast<double>(factor);
        sample = std::isnan(scaled) ? 0.0 : std::clamp(scaled, -limit, limit);
    }
    for (float& impulse : ringing_) {
        impulse = limitedOrZero(impulse * factor, std::max(largestRinging, std::fabs(impulse)));
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
