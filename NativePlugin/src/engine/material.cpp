#include "engine/material.hpp"

#include "inference/segment_generator.hpp"
#include "skeleton/gaussian_noise.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

namespace haptoflow::engine {

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

namespace {

constexpr float largestDeviation = 2.5F;
// Of a standard normal number that is limited to that. With the density p and the distribution P, its variance is
// 2 P(2.5) - 1 - 5 p(2.5) + 2 * 2.5^2 (1 - P(2.5)).
constexpr double limitedDeviation = 0.988716;
// Voices are numbered from 0.
constexpr std::uint32_t noVoice = std::numeric_limits<std::uint32_t>::max();

}  // namespace

std::array<float, model::embeddingSize> embeddingOf(const PreparedMaterial& material, ObjectIdentity object) noexcept {
    std::array<float, model::embeddingSize> embedding{};
    std::ranges::copy(material.embedding, embedding.begin());
    const std::size_t pieces = std::min(material.pieceOffsets.size() / model::textureSize, model::maximumPieces);
    if (object.variation == 0.0F || pieces < 2) {
        return embedding;
    }
    std::array<float, model::maximumPieces> numbers{};
    const auto drawn = std::span(numbers).first(pieces);
    skeleton::fillStandardNormal({.seed = object.surfaceSeed, .voice = noVoice}, drawn);
    std::array<double, model::textureSize> offset{};
    for (std::size_t piece = 0; piece < pieces; ++piece) {
        const auto number = static_cast<double>(std::clamp(drawn[piece], -largestDeviation, largestDeviation));
        const auto own = material.pieceOffsets.subspan(piece * model::textureSize).first<model::textureSize>();
        for (std::size_t j = 0; j < offset.size(); ++j) {
            offset[j] += number * static_cast<double>(own[j]);
        }
    }
    const double scale =
        static_cast<double>(object.variation) / (limitedDeviation * std::sqrt(static_cast<double>(pieces - 1)));
    for (std::size_t j = 0; j < offset.size(); ++j) {
        embedding[j] = static_cast<float>(static_cast<double>(embedding[j]) + scale * offset[j]);
    }
    return embedding;
}

double PreparedMaterial::logLevel(const std::array<float, 3>& motion) const noexcept {
    const double offset = label->levelOffsetDb * dsp::nepersPerDecibel;
    if (!label->level) {
        return grid->at(*graphLevels, motion) + offset;
    }
    const double own = label->level->logLevel(std::hypot(motion[0], motion[1]), motion[2], label->speedLevelExponent);
    return std::clamp(own + offset, -inference::maximumLogLevel, inference::maximumLogLevel);
}

double PreparedMaterial::forceExponent() const noexcept {
    return label->level ? label->level->forceExponent : label->forceLevelExponent;
}

namespace {

// Added to speed and force before taking logarithms, because smaller differences cannot be felt.
constexpr double restMps = 0.002;
constexpr double restNewtons = 0.05;
constexpr double forceShare = 0.5;
constexpr double directionShare = 0.1;

double distance(const Seed& seed, const std::array<float, 3>& motion) {
    const double speed = std::hypot(motion[0], motion[1]);
    const double seedSpeed = std::hypot(seed.velocityMps[0], seed.velocityMps[1]);
    const double speedGap = std::log((speed + restMps) / (seedSpeed + restMps));
    const double forceGap = std::log((motion[2] + restNewtons) / (seed.forceNewtons + restNewtons));
    const double along =
        (seed.velocityMps[0] * motion[0] + seed.velocityMps[1] * motion[1]) / (speed * seedSpeed + restMps * restMps);
    return speedGap * speedGap + forceShare * forceGap * forceGap + directionShare * (1.0 - along * along);
}

}  // namespace

const Seed* retrieveSeed(std::span<const Seed> seeds, const std::array<float, 3>& motion) noexcept {
    double nearest = std::numeric_limits<double>::infinity();
    const Seed* chosen = nullptr;
    for (const Seed& seed : seeds) {
        const double gap = distance(seed, motion);
        if (gap < nearest) {
            nearest = gap;
            chosen = &seed;
        }
    }
    return chosen;
}

}  // namespace haptoflow::engine
