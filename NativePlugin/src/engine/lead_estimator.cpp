#include "engine/lead_estimator.hpp"

#include <algorithm>

namespace haptoflow::engine {

void LeadEstimator::observe(std::int64_t advancedSamples) noexcept {
    advances_[count_ % window] = advancedSamples;
    ++count_;
}

std::int64_t LeadEstimator::samples(std::int64_t blockAdvance) const noexcept {
    const std::size_t known = std::min(count_, window);
    std::int64_t needed = 2 * blockAdvance + initialInferenceSamples;
    if (known >= 8) {
        std::int64_t highest = 0;
        std::int64_t second = 0;
        for (std::size_t i = 0; i < known; ++i) {
            if (advances_[i] >= highest) {
                second = highest;
                highest = advances_[i];
            } else {
                second = std::max(second, advances_[i]);
            }
        }
        needed = std::max((known == window ? second : highest) + 1, blockAdvance);
    }
    return std::clamp(needed, minimumSamples, maximumSamples);
}

}  // namespace haptoflow::engine
