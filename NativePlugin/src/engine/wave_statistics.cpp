#include "engine/wave_statistics.hpp"

#include <cstddef>

namespace haptoflow::engine {
namespace {

/// What a label says of one of its wave vectors; nothing if the label does not have it.
model::RibWander wanderIn(const PreparedMaterial& material, const WaveVector& vector) noexcept {
    const WaveVectors own = waveVectorsOf(material.embedding);
    for (std::size_t slot = 0; slot < own.size() && slot < material.label->ribWander.size(); ++slot) {
        if (own[slot] == vector) {
            return material.label->ribWander[slot];
        }
    }
    return {};
}

}  // namespace

WaveStatistics waveStatisticsOf(const Ingredients& ingredients, const WaveVectors& vectors) noexcept {
    WaveStatistics statistics;
    double heaviest = 0.0;
    for (const Ingredient& each : ingredients.all()) {
        const model::Label& label = *each.material->label;
        if (label.stickSlip && each.weight > heaviest) {
            statistics.slip = *label.stickSlip;
            heaviest = each.weight;
        }
        for (std::size_t slot = 0; slot < vectors.size(); ++slot) {
            if (!vectors[slot].isNone() && statistics.ribs[slot].turns == 0.0) {
                statistics.ribs[slot] = wanderIn(*each.material, vectors[slot]);
            }
        }
    }
    return statistics;
}

}  // namespace haptoflow::engine
