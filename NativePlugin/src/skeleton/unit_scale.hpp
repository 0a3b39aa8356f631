#pragma once

#include "skeleton/skeleton_layout.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace haptoflow::skeleton {

[[nodiscard]] inline float finiteOrZero(float value) noexcept {
    return std::isfinite(value) ? value : 0.0F;
}

/// `wave` divided by `scale` and limited to +-16; what is then not a number becomes 0. The waves may be the same.
inline void toUnitScale(Segment wave, float scale, std::span<float, segmentSamples> unit) noexcept {
    std::ranges::transform(wave, unit.begin(), [scale](float sample) {
        const float scaled = sample / scale;
        return std::isnan(scaled) ? 0.0F : std::clamp(scaled, -unitLimit, unitLimit);
    });
}

}  // namespace haptoflow::skeleton
