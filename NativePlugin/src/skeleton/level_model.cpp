#include "skeleton/level_model.hpp"

#include "skeleton/condition.hpp"
#include "skeleton/rib_rates.hpp"

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

}  // namespace haptoflow::skeleton
