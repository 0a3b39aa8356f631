#include "engine/rib_phase.hpp"

#include "skeleton/condition.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace haptoflow::engine {
namespace {

constexpr double largestCorrectionCycles = 0.1;
constexpr double millimetresPerMetre = 1000.0;

/// The slot of `vectors` that holds `vector`; if several do, preferably `preferred`. Empty if none does.
std::optional<std::size_t> slotOf(const WaveVectors& vectors, const WaveVector& vector,
                                  std::size_t preferred) noexcept {
    if (vectors[preferred] == vector) {
        return preferred;
    }
    const auto found = std::ranges::find(vectors, vector);
    return found == vectors.end() ? std::nullopt : std::optional(static_cast<std::size_t>(found - vectors.begin()));
}

}  // namespace

WaveVectors waveVectorsOf(std::span<const float, inference::embeddingSize> embedding) noexcept {
    const auto numbers = embedding.last<2 * inference::ribCount>();
    WaveVectors vectors;
    for (std::size_t slot = 0; slot < vectors.size(); ++slot) {
        vectors[slot] = {.x = numbers[2 * slot], .y = numbers[2 * slot + 1]};
    }
    return vectors;
}

void setWaveVectors(std::span<float, inference::embeddingSize> embedding, const WaveVectors& vectors) noexcept {
    const auto numbers = embedding.last<2 * inference::ribCount>();
    for (std::size_t slot = 0; slot < vectors.size(); ++slot) {
        numbers[2 * slot] = vectors[slot].x;
        numbers[2 * slot + 1] = vectors[slot].y;
    }
}

WaveVectors keepingSlots(const WaveVectors& vectors, const WaveVectors& before) noexcept {
    WaveVectors kept{};
    std::array<bool, inference::ribCount> isTaken{};
    std::array<bool, inference::ribCount> isPlaced{};
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

RibCycles phasesFor(const WaveVectors& vectors, const WaveVectors& from, const RibCycles& phases) noexcept {
    RibCycles result = phases;
    for (std::size_t slot = 0; slot < vectors.size(); ++slot) {
        result[slot] = phases[slotOf(from, vectors[slot], slot).value_or(slot)];
    }
    return result;
}

RibCycles ribCyclesPerSample(std::span<const float, inference::embeddingSize> embedding, double vxMps,
                             double vyMps) noexcept {
    RibCycles cycles = skeleton::ribRatesHz(embedding, vxMps, vyMps);
    std::ranges::for_each(cycles, [](double& each) { each /= inference::waveformRateHz; });
    return cycles;
}

std::array<float, inference::ribCount> toNetwork(const RibCycles& phases) noexcept {
    std::array<float, inference::ribCount> rounded{};
    std::ranges::transform(phases, rounded.begin(), skeleton::wrapped);
    return rounded;
}

void RibTrack::begin(std::int64_t start, const SeedRibs& seed) noexcept {
    piece_ = {.start = start, .phase = seed.phase, .cyclesPerSample = seed.cyclesPerSample, .vectors = seed.vectors};
    isFirst_ = true;
}

RibCycles RibTrack::at(std::int64_t sample, const WaveVectors& vectors,
                       const std::array<double, 2>& placeMetres) const noexcept {
    RibCycles cycles = at(sample, vectors);
    for (std::size_t rib = 0; rib < cycles.size(); ++rib) {
        const double wanted = (static_cast<double>(vectors[rib].x) * placeMetres[0] +
                               static_cast<double>(vectors[rib].y) * placeMetres[1]) *
                              millimetresPerMetre;
        const double missing = wanted - cycles[rib] - std::round(wanted - cycles[rib]);
        cycles[rib] +=
            isFirst_ ? missing : std::clamp(0.5 * missing, -largestCorrectionCycles, largestCorrectionCycles);
        cycles[rib] -= std::floor(cycles[rib]);
    }
    return cycles;
}

void RibTrack::add(std::int64_t start, const WaveVectors& vectors, const RibCycles& phase,
                   const RibCycles& cyclesPerSample) noexcept {
    piece_ = {.start = start, .phase = phase, .cyclesPerSample = cyclesPerSample, .vectors = vectors};
    isFirst_ = false;
}

RibCycles RibTrack::at(std::int64_t sample, const WaveVectors& vectors) const noexcept {
    RibCycles cycles{};
    for (std::size_t rib = 0; rib < cycles.size(); ++rib) {
        const double travelled =
            piece_.phase[rib] + piece_.cyclesPerSample[rib] * static_cast<double>(sample - piece_.start);
        cycles[rib] = travelled - std::floor(travelled);
    }
    return phasesFor(vectors, piece_.vectors, cycles);
}

}  // namespace haptoflow::engine
