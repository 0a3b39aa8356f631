#include "skeleton/condition.hpp"

#include <algorithm>
#include <cmath>

namespace haptoflow::skeleton {
namespace {

constexpr double millimetresPerMetre = 1000.0;

constexpr double restSpeedMps = 0.0005;
constexpr double referenceSpeedMps = 0.06;
constexpr double restForceNewtons = 0.02;
// Below this speed the direction fades, because it cannot be measured.
constexpr double directionSpeedMps = 0.002;

constexpr std::array<double, 5> fineHarmonics{0.5, 1.0, 2.0, 4.0, 8.0};
constexpr std::array<double, 2> smoothHarmonics{0.5, 1.0};

double speedOf(const Motion& motion) noexcept {
    return std::hypot(static_cast<double>(motion[0]), static_cast<double>(motion[1]));
}

template <std::size_t Count>
std::array<float, 8 + 2 * Count> featuresOf(const Motion& motion, const std::array<double, Count>& harmonics) noexcept {
    const LogMotion logarithms = logMotionOf(motion);
    const double speed = speedOf(motion);
    const double x = static_cast<double>(motion[0]) / (speed + directionSpeedMps);
    const double y = static_cast<double>(motion[1]) / (speed + directionSpeedMps);
    std::array<float, 8 + 2 * Count> features{};
    auto* next = features.data();
    const auto put = [&next](double value) { *next++ = static_cast<float>(value); };
    put(0.5 * logarithms.speed);
    put(0.5 * logarithms.force);
    put(x);
    put(y);
    put(x * x - y * y);
    put(2.0 * x * y);
    for (const double harmonic : harmonics) {
        put(std::sin(harmonic * logarithms.speed));
        put(std::cos(harmonic * logarithms.speed));
    }
    put(speed);
    put(0.2 * static_cast<double>(motion[2]));
    return features;
}

static_assert(fineFeatures == 8 + 2 * fineHarmonics.size());
static_assert(smoothFeatures == 8 + 2 * smoothHarmonics.size());

// Around this rate the direction turns.
constexpr double turningHz = 20.0;

}  // namespace

std::array<double, ribCount> ribRatesHz(std::span<const float, embeddingSize> embedding, double vxMps,
                                        double vyMps) noexcept {
    const auto vectors = embedding.last<2 * ribCount>();
    std::array<double, ribCount> rates{};
    for (std::size_t rib = 0; rib < rates.size(); ++rib) {
        rates[rib] =
            (static_cast<double>(vectors[2 * rib]) * vxMps + static_cast<double>(vectors[2 * rib + 1]) * vyMps) *
            millimetresPerMetre;
    }
    return rates;
}

Phases phasesOf(std::span<const float, embeddingSize> embedding, const Motion& motion,
                const std::array<float, ribCount>& cycles) noexcept {
    Phases phases{};
    std::ranges::copy(cycles, phases.begin());
    std::ranges::transform(ribRatesHz(embedding, static_cast<double>(motion[0]), static_cast<double>(motion[1])),
                           phases.begin() + familyCount, [](double rateHz) { return static_cast<float>(rateHz); });
    return phases;
}

float wrapped(double cycles) noexcept {
    const auto phase = static_cast<float>(cycles - std::floor(cycles));
    // Rounding could lift a phase just below one turn to 1.
    return phase < 1.0F ? phase : 0.0F;
}

Phases advanced(const Phases& phases, double samples) noexcept {
    Phases later = phases;
    for (std::size_t family = 0; family < familyCount; ++family) {
        later[family] = wrapped(static_cast<double>(phases[family]) +
                                static_cast<double>(phases[familyCount + family]) * samples / waveformRateHz);
    }
    return later;
}

LogMotion logMotionOf(const Motion& motion) noexcept {
    return {.speed = std::log((speedOf(motion) + restSpeedMps) / referenceSpeedMps),
            .force = std::log(std::max(static_cast<double>(motion[2]), 0.0) + restForceNewtons)};
}

std::array<float, fineFeatures> fineFeaturesOf(const Motion& motion) noexcept {
    return featuresOf(motion, fineHarmonics);
}

std::array<float, smoothFeatures> smoothFeaturesOf(const Motion& motion) noexcept {
    return featuresOf(motion, smoothHarmonics);
}

float rateSize(double rateHz) noexcept {
    return static_cast<float>(0.25 * std::log1p(std::fabs(rateHz)));
}

Condition conditionOf(std::span<const float, embeddingSize> embedding, const Motion& motion,
                      const Phases& phases) noexcept {
    Condition condition{};
    std::ranges::transform(embedding, condition.begin(), finiteOrZero);
    std::ranges::copy(fineFeaturesOf({finiteOrZero(motion[0]), finiteOrZero(motion[1]), finiteOrZero(motion[2])}),
                      condition.begin() + embeddingSize);
    const auto rates = std::span(condition).last<rateFeatures>();
    for (std::size_t family = 0; family < familyCount; ++family) {
        const auto rateHz = static_cast<double>(finiteOrZero(phases[familyCount + family]));
        rates[family] = rateSize(rateHz);
        rates[familyCount + family] = static_cast<float>(rateHz / (std::fabs(rateHz) + turningHz));
    }
    return condition;
}

}  // namespace haptoflow::skeleton
