#include "engine/material.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace haptoflow::engine {

std::uint32_t sanitise(ContactState& state) noexcept {
    constexpr float maximumMps = 20.0F;
    constexpr float maximumNewtons = 1000.0F;
    constexpr float minimumScale = 0.25F;
    constexpr float maximumScale = 4.0F;
    constexpr float maximumTilt = 12.0F;
    std::uint32_t changes = 0;
    const auto limit = [&changes](float& value, float lowest, float highest) {
        const float inRange = std::isfinite(value) ? std::clamp(value, lowest, highest) : 0.0F;
        if (inRange != value) {
            value = inRange;
            ++changes;
        }
    };
    for (float& component : state.velocityMps) {
        limit(component, -maximumMps, maximumMps);
    }
    limit(state.forceNewtons, 0.0F, maximumNewtons);
    limit(state.approachSpeedMps, -maximumMps, maximumMps);
    limit(state.edgeHeightMetres, 0.0F, 1.0F);
    if (state.material.count > MaterialBlend::capacity) {
        state.material.count = MaterialBlend::capacity;
        ++changes;
    }
    for (std::size_t i = 0; i < state.material.count; ++i) {
        limit(state.material.entries[i].weight, 0.0F, 1.0F);
    }
    if (state.spatialScale == 0.0F) {
        state.spatialScale = 1.0F;
    } else if (!std::isfinite(state.spatialScale)) {
        state.spatialScale = 1.0F;
        ++changes;
    }
    limit(state.spatialScale, minimumScale, maximumScale);
    limit(state.toneDbPerOctave, -maximumTilt, maximumTilt);
    if (!std::isfinite(state.timeSeconds)) {
        state.timeSeconds = 0.0;
        ++changes;
    }
    return changes;
}

Material resolveMaterial(const Ingredients& ingredients, const WaveVectors& before) noexcept {
    Material material;
    std::array<double, model::embeddingSize> embedding{};
    for (const Ingredient& each : ingredients.all()) {
        const model::Label& label = *each.material->label;
        for (std::size_t j = 0; j < embedding.size(); ++j) {
            embedding[j] += each.weight * static_cast<double>(each.material->embedding[j]);
        }
        material.speedLevelExponent += each.weight * label.speedLevelExponent;
        material.forceLevelExponent += each.weight * each.material->forceExponent();
        material.frequencyExponent += each.weight * label.frequencyExponent;
    }
    const double total = ingredients.totalWeight();
    for (std::size_t j = 0; j < embedding.size(); ++j) {
        material.embedding[j] = static_cast<float>(embedding[j] / total);
    }
    setWaveVectors(material.embedding, assignRibs(ingredients, before));
    material.speedLevelExponent /= total;
    material.forceLevelExponent /= total;
    material.frequencyExponent /= total;
    return material;
}

WaveVectors assignRibs(const Ingredients& ingredients, const WaveVectors& before) noexcept {
    if (!ingredients.isBlend()) {
        return waveVectorsOf(ingredients.entries[0].material->embedding);
    }
    WaveVectors chosen{};
    std::size_t count = 0;
    Ingredients left = ingredients;
    for (std::size_t round = 0; round < ingredients.count; ++round) {
        Ingredient& heaviest =
            *std::ranges::max_element(std::span(left.entries).first(left.count), {}, &Ingredient::weight);
        const Ingredient each = heaviest;
        heaviest.weight = -1.0;
        for (const WaveVector& candidate : waveVectorsOf(each.material->embedding)) {
            const auto known = std::span(chosen).first(count);
            if (count < chosen.size() && !candidate.isNone() && std::ranges::find(known, candidate) == known.end()) {
                chosen[count] = candidate;
                ++count;
            }
        }
    }
    return keepingSlots(chosen, before);
}

std::optional<dsp::ToneCepstrum> resolveTone(const Ingredients& ingredients, double speedMps, double tiltDbPerOctave,
                                             const dsp::ToneCepstrum& tiltPerDecibel) noexcept {
    const bool hasTone =
        std::ranges::any_of(ingredients.all(), [](const Ingredient& each) { return each.material->tone.has_value(); });
    if (!hasTone && tiltDbPerOctave == 0.0) {
        return std::nullopt;
    }
    dsp::ToneCepstrum tone{};
    const auto add = [&tone](const dsp::ToneCepstrum& cepstrum, double share) {
        std::ranges::transform(tone, cepstrum, tone.begin(),
                               [share](double sum, double value) { return sum + share * value; });
    };
    const double total = ingredients.totalWeight();
    for (const Ingredient& each : ingredients.all()) {
        if (each.material->tone) {
            add(each.material->tone->at(speedMps), each.weight / total);
        }
    }
    add(tiltPerDecibel, tiltDbPerOctave);
    return tone;
}

dsp::ToneCepstrum designTilt() {
    constexpr double pivotHz = 150.0;
    constexpr double lowestHz = 10.0;
    return dsp::toneCepstrum([=](double frequencyHz) { return std::log2(std::max(frequencyHz, lowestHz) / pivotHz); });
}

}  // namespace haptoflow::engine
