#include "engine/prepared_material.hpp"

#include "inference/segment_generator.hpp"

#include <algorithm>
#include <cmath>

namespace haptoflow::engine {

double PreparedMaterial::logLevel(const std::array<float, 3>& motion) const noexcept {
    const double offset = label->levelOffsetDb * dsp::nepersPerDecibel;
    if (!label->level) {
        return grid->at(*graphLevels, motion) + offset;
    }
    const double own = label->level->logLevel(std::hypot(motion[0], motion[1]), motion[2], label->speedLevelExponent);
    return std::clamp(own + offset, -inference::maximumLogLevel, inference::maximumLogLevel);
}

double PreparedMaterial::forceExponent() const noexcept {
    return label->level ? label->level->forceExponent : label->forceLevelExponent;
}

}  // namespace haptoflow::engine
