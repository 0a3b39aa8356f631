#include "engine/surface_phases.hpp"

#include "engine/surface_wander.hpp"
#include "skeleton/rib_rates.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace haptoflow::engine {
namespace {

constexpr std::size_t slipFamily = inference::ribCount;
// The way from slip to slip grows with the force to this power; lighter forces count as the lightest.
constexpr double slipForceExponent = 0.4;
constexpr double lightestSlipNewtons = 0.05;

/// The field that one family follows.
WanderPoint wanderOf(std::size_t family, double wavelengthMetres, const SurfaceStretch& stretch) noexcept {
    constexpr std::uint64_t step = 0x9E3779B97F4A7C15U;
    return surfaceWander(stretch.surface + step * (family + 1U), wavelengthMetres, stretch.path);
}

double slipWander(const model::StickSlip& slip, const SurfaceStretch& stretch) noexcept {
    return slip.wanderMetres > 0.0 ? wanderOf(slipFamily, slip.wanderMetres, stretch).value : 0.0;
}

void setFamily(skeleton::Phases& phases, std::size_t family, double turns, double turnsPerSample) noexcept {
    phases[family] = skeleton::wrapped(turns);
    phases[skeleton::familyCount + family] = static_cast<float>(turnsPerSample * inference::waveformRateHz);
}

}  // namespace

double slipsPerSample(const model::StickSlip& slip, const std::array<float, 3>& motion, double wander) noexcept {
    if (!(slip.lengthMetres > 0.0)) {
        return 0.0;
    }
    const double pressed = std::pow(std::max(static_cast<double>(motion[2]), lightestSlipNewtons), slipForceExponent);
    const double wayMetres = slip.lengthMetres * pressed * std::exp(slip.wander * wander);
    const double speedMps = std::hypot(static_cast<double>(motion[0]), static_cast<double>(motion[1]));
    return speedMps / (wayMetres * inference::waveformRateHz);
}

void setSlips(skeleton::Phases& phases, double turns, double turnsPerSample) noexcept {
    setFamily(phases, slipFamily, turns, turnsPerSample);
}

void SurfacePhases::begin(std::int64_t start, const SeedRibs& seed) noexcept {
    ribs_.begin(start, seed);
    slips_ = {.start = start};
}

skeleton::Phases SurfacePhases::at(std::int64_t start, std::span<const float, inference::embeddingSize> embedding,
                                   const std::array<float, 3>& motion, const WaveStatistics& statistics,
                                   const SurfaceStretch& stretch) noexcept {
    vectors_ = waveVectorsOf(embedding);
    phase_ = stretch.ribPlaceMetres ? ribs_.at(start, vectors_, *stretch.ribPlaceMetres) : ribs_.at(start, vectors_);
    turnsPerSample_ = ribTurnsPerSample(embedding, static_cast<double>(motion[0]), static_cast<double>(motion[1]));
    const double slipped = slips_.phase + slips_.turnsPerSample * static_cast<double>(start - slips_.start);
    slip_ = {.start = start,
             .phase = slipped - std::floor(slipped),
             .turnsPerSample = slipsPerSample(statistics.slip, motion, slipWander(statistics.slip, stretch))};

    skeleton::Phases phases{};
    for (std::size_t family = 0; family < inference::ribCount; ++family) {
        const model::RibWander& wander = statistics.ribs[family];
        WanderPoint point;
        if (wander.turns > 0.0 && wander.wavelengthMetres > 0.0) {
            point = wanderOf(family, wander.wavelengthMetres, stretch);
        }
        setFamily(phases, family, phase_[family] + wander.turns * point.value,
                  turnsPerSample_[family] + wander.turns * point.changePerSample);
    }
    setSlips(phases, slip_.phase, slip_.turnsPerSample);
    return phases;
}

void SurfacePhases::add() noexcept {
    ribs_.add(slip_.start, vectors_, phase_, turnsPerSample_);
    slips_ = slip_;
}

}  // namespace haptoflow::engine
