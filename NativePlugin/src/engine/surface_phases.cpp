#include "engine/surface_phases.hpp"

#include "inference/gaussian_noise.hpp"
#include "inference/surface_noise.hpp"
#include "skeleton/condition.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace haptoflow::engine {
namespace {

constexpr std::uint64_t waves = 12;
constexpr std::uint64_t numbersPerWave = 4;
constexpr double octaves = 0.5;
// A surface cuts the waves at an angle, which makes them longer. This restores the mean square slope that waves within
// the surface have: 2/3 of a direction's square lies in a plane, half of it along a path.
const double shortening = std::sqrt(1.5);

}  // namespace

WanderPoint surfaceWander(std::uint64_t key, double wavelengthMetres, const inference::SurfacePath& path) noexcept {
    constexpr double wholeTurn = 2.0 * std::numbers::pi;
    const double size = std::sqrt(2.0 / static_cast<double>(waves));
    WanderPoint point;
    for (std::uint64_t wave = 0; wave < waves; ++wave) {
        std::array<double, numbersPerWave> drawn{};
        for (std::size_t number = 0; number < numbersPerWave; ++number) {
            drawn[number] = inference::fractionOf(key, wave * numbersPerWave + number);
        }
        // Uniform on the sphere: height and angle are independent.
        const double height = 2.0 * drawn[0] - 1.0;
        const double across = std::sqrt(1.0 - height * height);
        const double turn = wholeTurn * drawn[1];
        const double cycles = shortening * std::exp2(octaves * (2.0 * drawn[2] - 1.0)) / wavelengthMetres;
        const std::array<double, 3> direction{across * std::cos(turn), across * std::sin(turn), height};
        double phase = drawn[3];
        double step = 0.0;
        for (std::size_t axis = 0; axis < direction.size(); ++axis) {
            phase += cycles * direction[axis] * path.startMetres[axis];
            step += cycles * direction[axis] * path.stepMetres[axis];
        }
        const double angle = wholeTurn * (phase - std::floor(phase));
        point.value += size * std::cos(angle);
        point.changePerSample -= size * wholeTurn * step * std::sin(angle);
    }
    return point;
}

namespace {

// From the noise to the vibration: two samples of the resampler and one of the filters (measured).
constexpr double outputDelaySamples = 3.0;

}  // namespace

void SurfaceTrack::begin(std::int64_t start, const SeedRibs& seed) noexcept {
    phases_.begin(start, seed);
    places_.begin();
}

skeleton::Phases SurfaceTrack::at(const PublishedContact& contact, const MaterialInputs& material, std::int64_t start,
                                  double secondsAhead) noexcept {
    stretch_ = places_.at(contact, start, secondsAhead);
    return phases_.at(start, material.embedding, contact.ranged.motion, material.waves, stretch_);
}

void SurfaceTrack::add(std::int64_t start) noexcept {
    places_.add(start, stretch_);
    phases_.add();
}

double secondsAhead(double samples, double readingRate, double sincePublishedSeconds) noexcept {
    const double fromBlock = (samples + outputDelaySamples) / (inference::waveformRateHz * readingRate);
    return std::clamp(fromBlock + sincePublishedSeconds, 0.0, SurfaceTrack::maximumSecondsAhead);
}

void fillNoise(std::uint64_t surface, const inference::SurfacePath& path, const inference::NoiseKey& otherwise,
               std::span<float> noise) noexcept {
    if (!inference::fillSurfaceNoise(surface, path, noise)) {
        inference::fillStandardNormal(otherwise, noise);
    }
}

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

void setFamily(skeleton::Phases& phases, std::size_t family, double cycles, double cyclesPerSample) noexcept {
    phases[family] = skeleton::wrapped(cycles);
    phases[skeleton::familyCount + family] = static_cast<float>(cyclesPerSample * inference::waveformRateHz);
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

void setSlips(skeleton::Phases& phases, double cycles, double cyclesPerSample) noexcept {
    setFamily(phases, slipFamily, cycles, cyclesPerSample);
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
    cyclesPerSample_ = ribCyclesPerSample(embedding, static_cast<double>(motion[0]), static_cast<double>(motion[1]));
    const double slipped = slips_.phase + slips_.cyclesPerSample * static_cast<double>(start - slips_.start);
    slip_ = {.start = start,
             .phase = slipped - std::floor(slipped),
             .cyclesPerSample = slipsPerSample(statistics.slip, motion, slipWander(statistics.slip, stretch))};

    skeleton::Phases phases{};
    for (std::size_t family = 0; family < inference::ribCount; ++family) {
        const model::RibWander& wander = statistics.ribs[family];
        WanderPoint point;
        if (wander.cycles > 0.0 && wander.wavelengthMetres > 0.0) {
            point = wanderOf(family, wander.wavelengthMetres, stretch);
        }
        setFamily(phases, family, phase_[family] + wander.cycles * point.value,
                  cyclesPerSample_[family] + wander.cycles * point.changePerSample);
    }
    setSlips(phases, slip_.phase, slip_.cyclesPerSample);
    return phases;
}

void SurfacePhases::add() noexcept {
    ribs_.add(slip_.start, vectors_, phase_, cyclesPerSample_);
    slips_ = slip_;
}

}  // namespace haptoflow::engine
