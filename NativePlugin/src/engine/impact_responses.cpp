#include "engine/impact_responses.hpp"

#include "engine/tap_pieces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace haptoflow::engine {
namespace {

using effects::ImpactResponse;
static_assert(ImpactResponse::modeCount == model::Impact::maximumModes);

/// Weighted sums of one mode over the labels of a blend.
struct MeanMode {
    double weight = 0.0;
    double logFrequency = 0.0;
    double logDecay = 0.0;
    double gain = 0.0;

    void add(double share, const ImpactResponse::Mode& mode) noexcept {
        if (!(mode.frequencyHz > 0.0F && mode.decayPerSecond > 0.0F)) {
            return;
        }
        weight += share;
        logFrequency += share * std::log(static_cast<double>(mode.frequencyHz));
        logDecay += share * std::log(static_cast<double>(mode.decayPerSecond));
        gain += share * static_cast<double>(mode.gainPerSecond);
    }

    /// `total` is the weight of all labels. Labels without this mode make it weaker.
    [[nodiscard]] ImpactResponse::Mode mode(double total) const noexcept {
        if (!(weight > 0.0)) {
            return {};
        }
        return {.frequencyHz = static_cast<float>(std::exp(logFrequency / weight)),
                .decayPerSecond = static_cast<float>(std::exp(logDecay / weight)),
                .gainPerSecond = static_cast<float>(gain / total)};
    }
};

double stiffnessHz(const model::Label& label) noexcept {
    return std::clamp(5.0 * std::sqrt(label.stiffnessNewtonsPerMetre), 25.0, 450.0);
}

/// Whether the header's main mode repeats what follows from the stiffness, rounded as training writes it.
bool statesOnlyStiffness(const model::Label& label) noexcept {
    return !label.impact || std::abs(label.impact->modes[0].frequencyHz - stiffnessHz(label)) < 0.01;
}

}  // namespace

ImpactResponse impactResponse(const model::Label& label) noexcept {
    ImpactResponse response;
    if (const TapPiece* piece = tapPieceOf(label); piece != nullptr && statesOnlyStiffness(label)) {
        response = tapOn(*piece);
        response.restitution = label.impact ? static_cast<float>(label.impact->restitution) : 0.0F;
        return response;
    }
    if (label.impact) {
        for (std::size_t i = 0; i < response.modes.size(); ++i) {
            const model::ImpactMode& mode = label.impact->modes[i];
            response.modes[i] = {.frequencyHz = static_cast<float>(mode.frequencyHz),
                                 .decayPerSecond = static_cast<float>(mode.decayPerSecond),
                                 .gainPerSecond = static_cast<float>(mode.gainPerSecond)};
        }
        response.restitution = static_cast<float>(label.impact->restitution);
        return response;
    }
    const double frequencyHz = stiffnessHz(label);
    response.modes[0] = {.frequencyHz = static_cast<float>(frequencyHz),
                         .decayPerSecond = static_cast<float>(60.0 + 0.15 * frequencyHz),
                         .gainPerSecond = static_cast<float>(0.15 * 2.0 * std::numbers::pi * frequencyHz)};
    return response;
}

ImpactResponse impactResponse(const Ingredients& ingredients) noexcept {
    std::array<MeanMode, ImpactResponse::modeCount> means{};
    const double total = ingredients.totalWeight();
    double restitution = 0.0;
    for (const Ingredient& each : ingredients.all()) {
        const ImpactResponse own = impactResponse(*each.material->label);
        for (std::size_t mode = 0; mode < means.size(); ++mode) {
            means[mode].add(each.weight, own.modes[mode]);
        }
        restitution += each.weight * static_cast<double>(own.restitution);
    }
    ImpactResponse response;
    for (std::size_t mode = 0; mode < means.size(); ++mode) {
        response.modes[mode] = means[mode].mode(total);
    }
    response.restitution = static_cast<float>(restitution / total);
    return response;
}

}  // namespace haptoflow::engine
