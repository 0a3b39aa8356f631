#include "skeleton/condition.hpp"

#include "skeleton/unit_scale.hpp"

#include <algorithm>

namespace haptoflow::skeleton {

Condition conditionOf(std::span<const float, embeddingSize> embedding, const Motion& motion) noexcept {
    Condition condition{};
    std::ranges::transform(embedding, condition.begin(), finiteOrZero);
    std::ranges::copy(fineFeaturesOf({finiteOrZero(motion[0]), finiteOrZero(motion[1]), finiteOrZero(motion[2])}),
                      condition.begin() + embeddingSize);
    return condition;
}

}  // namespace haptoflow::skeleton
