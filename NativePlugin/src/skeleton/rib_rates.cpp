#include "skeleton/rib_rates.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace haptoflow::skeleton {
namespace {

constexpr double millimetresPerMetre = 1000.0;

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
                const std::array<float, ribCount>& turns) noexcept {
    Phases phases{};
    std::ranges::copy(turns, phases.begin());
    std::ranges::transform(ribRatesHz(embedding, static_cast<double>(motion[0]), static_cast<double>(motion[1])),
                           phases.begin() + familyCount, [](double rateHz) { return static_cast<float>(rateHz); });
    return phases;
}

float wrapped(double turns) noexcept {
    const auto phase = static_cast<float>(turns - std::floor(turns));
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

}  // namespace haptoflow::skeleton
