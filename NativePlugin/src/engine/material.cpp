#include "engine/material.hpp"

#include "dsp/rate_warp.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace haptoflow::engine {
namespace {

constexpr double maximumGain = 16.0;

/// value / edge, at least 1.
double excess(double value, double edge) {
    return edge > 0.0 ? std::max(1.0, value / edge) : 1.0;
}

}  // namespace

WaveVectors waveVectorsOf(std::span<const float, model::embeddingSize> embedding) noexcept {
    const auto numbers = embedding.last<2 * skeleton::ribCount>();
    WaveVectors vectors;
    for (std::size_t slot = 0; slot < vectors.size(); ++slot) {
        vectors[slot] = {.x = numbers[2 * slot], .y = numbers[2 * slot + 1]};
    }
    return vectors;
}

void setWaveVectors(std::span<float, model::embeddingSize> embedding, const WaveVectors& vectors) noexcept {
    const auto numbers = embedding.last<2 * skeleton::ribCount>();
    for (std::size_t slot = 0; slot < vectors.size(); ++slot) {
        numbers[2 * slot] = vectors[slot].x;
        numbers[2 * slot + 1] = vectors[slot].y;
    }
}

WaveVectors keepingSlots(const WaveVectors& vectors, const WaveVectors& before) noexcept {
    WaveVectors kept{};
    std::array<bool, skeleton::ribCount> isTaken{};
    std::array<bool, skeleton::ribCount> isPlaced{};
    for (std::size_t slot = 0; slot < vectors.size(); ++slot) {
        const auto found = std::ranges::find(before, vectors[slot]);
        if (!vectors[slot].isNone() && found != before.end()) {
            const auto place = static_cast<std::size_t>(found - before.begin());
            kept[place] = vectors[slot];
            isTaken[place] = true;
            isPlaced[slot] = true;
        }
    }
    for (std::size_t slot = 0; slot < vectors.size(); ++slot) {
        if (!isPlaced[slot]) {
            const auto free = static_cast<std::size_t>(std::ranges::find(isTaken, false) - isTaken.begin());
            kept[free] = vectors[slot];
            isTaken[free] = true;
        }
    }
    return kept;
}

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
        for (const skeleton::WaveVector& candidate : waveVectorsOf(each.material->embedding)) {
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

RangedMotion applyRangeLaw(const model::ModelHeader& header, const Material& material,
                           const std::array<float, 2>& velocityMps, float forceNewtons, float spatialScale) noexcept {
    const double fastest = header.speedMps.maximum;
    const double force = forceNewtons;
    const double forceExcess = excess(force, header.forceNewtons.maximum);
    const auto clampedForce = static_cast<float>(std::max(force, header.forceNewtons.minimum) / forceExcess);
    const auto clamped = [&](double vx, double vy) -> std::array<float, 3> {
        const double speedExcess = excess(std::hypot(vx, vy), fastest);
        return {static_cast<float>(vx / speedExcess), static_cast<float>(vy / speedExcess), clampedForce};
    };
    const double scale = spatialScale;
    const double vx = velocityMps[0];
    const double vy = velocityMps[1];
    const double speedExcess = excess(std::hypot(vx, vy), fastest);
    const double featureExcess = excess(std::hypot(vx, vy) / scale, fastest);

    RangedMotion ranged;
    ranged.motion = clamped(vx / scale, vy / scale);
    ranged.levelMotion = clamped(vx, vy);
    ranged.levelGain = std::min(maximumGain, std::pow(speedExcess, material.speedLevelExponent) *
                                                 std::pow(forceExcess, material.forceLevelExponent));
    ranged.readingRate =
        std::clamp(std::pow(featureExcess, material.frequencyExponent), 1.0, dsp::RateWarp::maximumRatio);
    return ranged;
}

LevelRequest requestLevel(const Ingredients& ingredients, const RangedMotion& ranged) noexcept {
    const model::Label& label = *ingredients.entries[0].material->label;
    LevelRequest request{.levelMps2 = {}, .motion = ranged.levelMotion, .gain = 1.0F};
    if (ingredients.isBlend() || label.level) {
        request.levelMps2 = ingredients.levelMps2(ranged.levelMotion);
    } else if (label.levelOffsetDb != 0.0) {
        request.gain = static_cast<float>(std::exp(label.levelOffsetDb * std::numbers::ln10 / 20.0));
    }
    return request;
}

}  // namespace haptoflow::engine
