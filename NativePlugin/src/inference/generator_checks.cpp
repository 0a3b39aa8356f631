#include "inference/generator_checks.hpp"

#include "inference/load_limits.hpp"
#include "inference/tier_generator.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace haptoflow::inference {

std::size_t requireBatch(std::size_t batch) {
    if (batch < 1 || batch > maximumBatchSize) {
        throw std::invalid_argument("the maximum batch is " + std::to_string(batch) + "; expected 1 to 256");
    }
    return batch;
}

void requireSize(std::size_t found, std::size_t expected, const char* what) {
    if (found != expected) {
        throw std::invalid_argument(std::string(what) + " for " + std::to_string(expected) + " numbers; found " +
                                    std::to_string(found));
    }
}

void requireFinite(std::span<const float> segments, const char* source) {
    if (!std::ranges::all_of(segments, [](float sample) { return std::isfinite(sample); })) {
        throw InferenceError(std::string("the ") + source + " returned a waveform that is not finite");
    }
}

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
