#include "inference/level_rules.hpp"

#include "inference/inference_error.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace haptoflow::inference {

void requireRoomForLevels(std::span<const SegmentRequest> requests, std::span<const float> levelsMps2) {
    if (levelsMps2.size() != requests.size()) {
        throw std::invalid_argument("levels need room for " + std::to_string(requests.size()) + " numbers, not " +
                                    std::to_string(levelsMps2.size()));
    }
}

float levelOf(const SegmentRequest& request, float logLevel, const char* source) {
    if (!std::isfinite(logLevel) || logLevel > static_cast<float>(maximumLogLevel)) {
        throw InferenceError(std::string("the ") + source + " returned a logarithm of " + std::to_string(logLevel) +
                             "; expected a number up to 20");
    }
    // Lower levels cannot be felt, and dividing the previous waveform by them would overflow.
    return std::exp(std::max(logLevel, static_cast<float>(-maximumLogLevel))) * request.levelGain;
}

}  // namespace haptoflow::inference
