#include "engine/level_request.hpp"

#include <cmath>
#include <numbers>

namespace haptoflow::engine {

LevelRequest requestLevel(const Ingredients& ingredients, const RangedMotion& ranged) noexcept {
    const model::Label& label = *ingredients.entries[0].material->label;
    LevelRequest request{.levelMps2 = {}, .motion = ranged.levelMotion, .gain = 1.0F};
    if (ingredients.isBlend() || label.level) {
        request.levelMps2 = ingredients.levelMps2(ranged.levelMotion);
    } else if (label.levelOffsetDb != 0.0) {
        request.gain = static_cast<float>(std::exp(label.levelOffsetDb * std::numbers::ln10 / 20.0));
    }
    return request;
}

}  // namespace haptoflow::engine
