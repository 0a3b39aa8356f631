#include "bench/marking.hpp"

#include "bench/measurements.hpp"
#include "skeleton/condition.hpp"
#include "skeleton/skeleton.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace haptoflow::bench {
namespace {

using skeleton::LinearLayer;

LinearLayer zeros(std::size_t outputs, std::size_t inputs) {
    return {std::vector<float>(outputs * inputs), std::vector<float>(outputs)};
}

skeleton::HiddenLayers silentHidden(std::size_t inputs) {
    return {zeros(1, inputs), zeros(1, 1)};
}

/// A law whose level is linear in the embedding, quiet at one and loud at another.
LinearLayer markingLaw(std::span<const float> quiet, std::span<const float> loud) {
    double apart = 0.0;
    double place = 0.0;
    for (std::size_t i = 0; i < quiet.size(); ++i) {
        const double difference = static_cast<double>(loud[i]) - static_cast<double>(quiet[i]);
        apart += difference * difference;
        place += difference * static_cast<double>(quiet[i]);
    }
    if (!(apart > 0.0)) {
        throw MeasurementError("the model's first two labels are the same material");
    }
    const double rise = std::log(static_cast<double>(loudMps2) / static_cast<double>(quietMps2)) / apart;
    std::vector<float> weight(3 * quiet.size());
    for (std::size_t i = 0; i < quiet.size(); ++i) {
        weight[i] = static_cast<float>(rise * (static_cast<double>(loud[i]) - static_cast<double>(quiet[i])));
    }
    const auto bias = static_cast<float>(std::log(static_cast<double>(quietMps2)) - rise * place);
    return {weight, std::array<float, 3>{bias, 0.0F, 0.0F}};
}

}  // namespace

skeleton::NativeParts markingParts(const model::ModelFile& model, std::uint32_t quiet, std::uint32_t loud) {
    constexpr std::size_t familyOutputs = 2 * (skeleton::swingHarmonics + skeleton::lineHarmonics);
    const skeleton::Perceptron correction(silentHidden(skeleton::LevelModel::correctionInputs), zeros(1, 1));
    return {.level = std::make_shared<const skeleton::LevelModel>(
                markingLaw(model.embedding(quiet), model.embedding(loud)), correction),
            .skeleton = std::make_shared<const skeleton::Skeleton>(
                silentHidden(skeleton::Condition{}.size()),
                skeleton::OutputLayers{
                    .filter = zeros(skeleton::filterOrder + 1, 1),
                    .families = {zeros(familyOutputs, 1), zeros(familyOutputs, 1), zeros(familyOutputs, 1)},
                    .rungs = zeros(skeleton::RungImpulses::gainCount, 1)})};
}

}  // namespace haptoflow::bench
