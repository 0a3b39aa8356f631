#include "engine/material.hpp"

#include <algorithm>
#include <cmath>

namespace haptoflow::engine {

std::uint32_t sanitise(ContactState& state) noexcept {
    constexpr float fastestMps = 20.0F;
    constexpr float strongestNewtons = 1000.0F;
    std::uint32_t changes = 0;
    const auto limit = [&changes](float& value, float lowest, float highest) {
        const float inRange = std::isfinite(value) ? std::clamp(value, lowest, highest) : 0.0F;
        if (inRange != value) {
            value = inRange;
            ++changes;
        }
    };
    for (float& component : state.velocityMps) {
        limit(component, -fastestMps, fastestMps);
    }
    limit(state.forceNewtons, 0.0F, strongestNewtons);
    limit(state.approachSpeedMps, -fastestMps, fastestMps);
    limit(state.edgeHeightMetres, 0.0F, 1.0F);
    if (state.material.count > MaterialBlend::capacity) {
        state.material.count = MaterialBlend::capacity;
        ++changes;
    }
    for (std::size_t i = 0; i < state.material.count; ++i) {
        limit(state.material.entries[i].weight, 0.0F, 1.0F);
    }
    if (!std::isfinite(state.timeSeconds)) {
        state.timeSeconds = 0.0;
        ++changes;
    }
    return changes;
}

Material resolveMaterial(const model::ModelFile& model, const MaterialBlend& blend) noexcept {
    const auto& labels = model.header().labels;
    Material material;
    double total = 0.0;
    float largest = 0.0F;
    std::array<double, model::embeddingSize> embedding{};
    for (std::size_t i = 0; i < std::min(blend.count, MaterialBlend::capacity); ++i) {
        const LabelWeight entry = blend.entries[i];
        if (entry.label >= labels.size() || !(entry.weight > 0.0F)) {
            continue;
        }
        const model::Label& label = labels[entry.label];
        const double weight = entry.weight;
        const auto row = model.embedding(entry.label);
        for (std::size_t j = 0; j < embedding.size(); ++j) {
            embedding[j] += weight * row[j];
        }
        material.speedLevelExponent += weight * label.speedLevelExponent;
        material.forceLevelExponent += weight * label.forceLevelExponent;
        material.frequencyExponent += weight * label.frequencyExponent;
        total += weight;
        if (entry.weight > largest) {
            largest = entry.weight;
            material.dominantLabel = entry.label;
        }
    }
    if (!(total > 0.0)) {
        MaterialBlend first;
        first.entries[0] = {.label = 0, .weight = 1.0F};
        first.count = 1;
        return labels.empty() ? material : resolveMaterial(model, first);
    }
    for (std::size_t j = 0; j < embedding.size(); ++j) {
        material.embedding[j] = static_cast<float>(embedding[j] / total);
    }
    material.speedLevelExponent /= total;
    material.forceLevelExponent /= total;
    material.frequencyExponent /= total;
    return material;
}

}  // namespace haptoflow::engine
