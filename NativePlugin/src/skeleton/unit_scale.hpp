#pragma once

#include "skeleton/skeleton_layout.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace haptoflow::skeleton {

[[nodiscard]] inline float finiteOrZero(float value) noexcept {
    return std::isfinite(value) ? value : 0.0F;
}

/// A sample limited to +-`limit`; what is not a number becomes 0.
[[nodiscard]] inline float limitedOrZero(float sample, float limit) noexcept {
    return std::isnan(sample) ? 0.0F : std::clamp(sample, -limit, limit);
}

/// `waveMps2` divided by the level and limited to +-16. The waves may be the same.
inline void toUnitScale(Segment waveMps2, float levelMps2, std::span<float, segmentSamples> unit) noexcept {
    std::ranges::transform(waveMps2, unit.begin(),
                           [levelMps2](float sample) { return limitedOrZero(sample / levelMps2, unitLimit); });
}

}  // namespace haptoflow::skeleton
