#include "skeleton/skeleton.hpp"

#include "skeleton/condition.hpp"
#include "skeleton/skeleton_layout.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace haptoflow::skeleton {
namespace {

constexpr double largestCorrection = 0.9;

}  // namespace

LevelModel::LevelModel(LinearLayer law, Perceptron correction)
    : law_(std::move(law)), correction_(std::move(correction)) {}

float LevelModel::logLevel(std::span<const float, model::embeddingSize> embedding,
                           const Motion& motion) const noexcept {
    std::array<float, 3> law{};
    law_.apply(embedding, law);
    std::array<float, correctionInputs> given{};
    auto next = std::ranges::copy(embedding, given.begin()).out;
    next = std::ranges::copy(smoothFeaturesOf(motion), next).out;
    const auto ratesHz = ribRatesHz(embedding, static_cast<double>(motion[0]), static_cast<double>(motion[1]));
    std::ranges::transform(ratesHz, next, rateSize);
    std::array<float, 1> correction{};
    correction_.run(given, correction);
    const LogMotion logarithms = logMotionOf(motion);
    return static_cast<float>(static_cast<double>(law[0]) + static_cast<double>(law[1]) * logarithms.speed +
                              static_cast<double>(law[2]) * logarithms.force +
                              largestCorrection * std::tanh(static_cast<double>(correction[0])));
}

namespace {

constexpr float largestSwing = 2.0F;

/// The outputs of one family, in the perceptron's order.
FamilyGains gainsOf(std::span<const float, 2 * (swingHarmonics + lineHarmonics)> outputs) noexcept {
    FamilyGains gains;
    const float* next = outputs.data();
    const auto take = [&next](auto& part) {
        std::copy_n(next, part.size(), part.begin());
        next += part.size();
    };
    take(gains.swingCosine);
    take(gains.swingSine);
    take(gains.lineCosine);
    take(gains.lineSine);
    return gains;
}

/// What drives the filter: the noise, which swings with the waves, the waves' lines, both times `gain`, and the
/// impulses.
std::array<float, segmentSamples> driveOf(Segment noise, Segment impulses, float gain,
                                          const SurfaceWaves& waves) noexcept {
    std::array<float, segmentSamples> drive{};
    if (!waves.isHeard()) {
        std::ranges::transform(noise, impulses, drive.begin(),
                               [gain](float sample, float impulse) { return gain * sample + impulse; });
        return drive;
    }
    for (std::size_t n = 0; n < segmentSamples; ++n) {
        const float swing = largestSwing * std::tanh(waves.swing()[n] / largestSwing);
        drive[n] = gain * (noise[n] * std::exp(swing) + waves.lines()[n]) + impulses[n];
    }
    return drive;
}

}  // namespace

struct Skeleton::Pulses {
    SurfaceWaves::Pulses cosines{};
    SurfaceWaves::Pulses sines{};
};

Skeleton::Skeleton(HiddenLayers hidden, OutputLayers outputs)
    : hidden_(std::move(hidden)), outputs_(std::move(outputs)) {}

std::array<FamilyPhase, familyCount> Skeleton::familiesOf(const Phases& phases) noexcept {
    std::array<FamilyPhase, familyCount> families{};
    for (std::size_t family = 0; family < familyCount; ++family) {
        families[family] = {.cycles = static_cast<double>(phases[family]),
                            .rateHz = static_cast<double>(phases[familyCount + family])};
    }
    return families;
}

ReflectionFilter Skeleton::filterOf(const HiddenLayers::Activations& activations) const noexcept {
    std::array<float, filterOrder + 1> outputs{};
    outputs_.filter.apply(activations, outputs);
    return ReflectionFilter::of(std::span(outputs).first<filterOrder>(), outputs.back());
}

ReflectionFilter Skeleton::filterFor(const Condition& condition) const noexcept {
    return filterOf(hidden_.run(condition));
}

SegmentParameters Skeleton::parametersFor(const Condition& condition,
                                          const std::array<FamilyPhase, familyCount>& phases,
                                          float impulseGain) const noexcept {
    const HiddenLayers::Activations activations = hidden_.run(condition);
    SegmentParameters parameters;
    parameters.filter = filterOf(activations);
    for (std::size_t family = 0; family < familyCount; ++family) {
        if (phases[family].isHeard()) {
            std::array<float, 2 * (swingHarmonics + lineHarmonics)> outputs{};
            outputs_.families[family].apply(activations, outputs);
            parameters.families[family] = gainsOf(outputs);
        }
    }
    outputs_.impulseGains.apply(activations, parameters.impulseGains);
    // Limited where they arise, as without a gain.
    std::ranges::for_each(parameters.impulseGains, [impulseGain](float& threshold) { threshold *= impulseGain; });
    return parameters;
}

void Skeleton::begin(const Moment& moment, const SegmentParameters& parameters,
                     std::span<float, segmentSamples> segment, std::span<float, segmentSamples> impulses,
                     Pulses* pulses) const noexcept {
    const auto phases = familiesOf(moment.phases);
    SurfaceWaves waves;
    for (std::size_t family = 0; family < familyCount; ++family) {
        if (phases[family].isHeard()) {
            waves.add(phases[family], parameters.families[family], pulses != nullptr ? &pulses->cosines : nullptr,
                      pulses != nullptr ? &pulses->sines : nullptr);
        }
    }
    std::array<float, segmentSamples> noise{};
    std::ranges::transform(moment.noise, noise.begin(), [](float sample) { return limitedOrZero(sample, noiseLimit); });
    const auto gain = static_cast<float>(std::exp(parameters.filter.logGain));
    impulses_.add(noise, parameters.impulseGains, impulses);
    std::ranges::for_each(impulses, [gain](float& impulse) { impulse *= gain; });
    parameters.filter.run(moment.previous.last<filterOrder>(), driveOf(noise, impulses, gain, waves), segment);
}

void Skeleton::sketch(const Moment& moment, const Condition& condition,
                      std::span<float, segmentSamples> segment) const noexcept {
    sketch(moment, parametersFor(condition, familiesOf(moment.phases), moment.impulseGain), segment);
}

void Skeleton::sketch(const Moment& moment, const SegmentParameters& parameters,
                      std::span<float, segmentSamples> segment) const noexcept {
    std::array<float, segmentSamples> impulses{};
    begin(moment, parameters, segment, impulses, nullptr);
}

void Skeleton::enter(const Moment& moment, const Condition& condition,
                     std::span<float, networkInputChannels * segmentSamples> networkInput) const noexcept {
    Pulses pulses;
    begin(moment, parametersFor(condition, familiesOf(moment.phases), moment.impulseGain),
          networkInput.first<segmentSamples>(), networkInput.subspan<segmentSamples, segmentSamples>(), &pulses);
    auto next = networkInput.begin() + 2 * segmentSamples;
    for (const SurfaceWaves::Pulses* each : {&pulses.cosines, &pulses.sines}) {
        for (const auto& harmonic : *each) {
            next = std::ranges::copy(harmonic, next).out;
        }
    }
}

}  // namespace haptoflow::skeleton
