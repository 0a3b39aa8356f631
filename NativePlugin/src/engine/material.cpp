#include "engine/material.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace haptoflow::engine {

Material resolveMaterial(const Ingredients& ingredients, const WaveVectors& before, ObjectIdentity object) noexcept {
    Material material;
    std::array<double, model::embeddingSize> embedding{};
    for (const Ingredient& each : ingredients.all()) {
        const model::Label& label = *each.material->label;
        const auto own = embeddingOf(*each.material, object);
        for (std::size_t j = 0; j < embedding.size(); ++j) {
            embedding[j] += each.weight * static_cast<double>(own[j]);
        }
        material.speedLevelExponent += each.weight * label.speedLevelExponent;
        material.forceLevelExponent += each.weight * each.material->forceExponent();
        material.frequencyExponent += each.weight * label.frequencyExponent;
        material.impulseGain += each.weight * static_cast<double>(label.impulseGain);
    }
    const double total = ingredients.totalWeight();
    for (std::size_t j = 0; j < embedding.size(); ++j) {
        material.embedding[j] = static_cast<float>(embedding[j] / total);
    }
    setWaveVectors(material.embedding, assignRibs(ingredients, before));
    material.speedLevelExponent /= total;
    material.forceLevelExponent /= total;
    material.frequencyExponent /= total;
    material.impulseGain /= total;
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

std::optional<dsp::ToneCepstrum> resolveTone(const Ingredients& ingredients, double speedMps, double newtons,
                                             double tiltDbPerOctave, const dsp::ToneCepstrum& tiltPerDecibel) noexcept {
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
            add(each.material->tone->at(speedMps, newtons), each.weight / total);
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
