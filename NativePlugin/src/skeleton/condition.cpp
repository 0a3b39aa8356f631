#include "skeleton/condition.hpp"

#include "skeleton/unit_scale.hpp"

#include <algorithm>
#include <cmath>

namespace haptoflow::skeleton {
namespace {

// Around this rate the direction turns.
constexpr double turningHz = 20.0;

}  // namespace

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
