#include "skeleton/skeleton.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace haptoflow::skeleton {
namespace {

constexpr double largestCorrection = 0.9;

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

double logPowerOf(const SkeletonParameters& parameters, const std::array<double, familyCount>& ratesHz) noexcept {
    double power = parameters.filter.variance();
    for (std::size_t family = 0; family < familyCount; ++family) {
        for (std::size_t harmonic = 1; isHeardHz(ratesHz[family]) && harmonic <= lineHarmonics; ++harmonic) {
            const double line = linePower(parameters.families[family], ratesHz[family], harmonic);
            if (line > 0.0) {
                power += line * parameters.filter.powerGain(static_cast<double>(harmonic) * ratesHz[family]);
            }
        }
    }
    return std::log(power);
}

Skeleton::Skeleton(HiddenLayers hidden, OutputLayers outputs)
    : hidden_(std::move(hidden)), outputs_(std::move(outputs)) {}

ReflectionFilter Skeleton::filterOf(const HiddenLayers::Activations& activations) const noexcept {
    std::array<float, filterOrder + 1> outputs{};
    outputs_.filter.apply(activations, outputs);
    return ReflectionFilter::of(std::span(outputs).first<filterOrder>(), outputs.back());
}

ReflectionFilter Skeleton::filterFor(const Condition& condition) const noexcept {
    return filterOf(hidden_.run(condition));
}

SkeletonParameters Skeleton::parametersFor(const Condition& condition, const std::array<double, familyCount>& ratesHz,
                                           float impulseGain) const noexcept {
    const HiddenLayers::Activations activations = hidden_.run(condition);
    SkeletonParameters parameters;
    parameters.filter = filterOf(activations);
    for (std::size_t family = 0; family < familyCount; ++family) {
        if (isHeardHz(ratesHz[family])) {
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

}  // namespace haptoflow::skeleton
