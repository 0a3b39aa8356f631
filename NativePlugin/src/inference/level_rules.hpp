#pragma once

#include "inference/segment_generator.hpp"

#include <array>
#include <span>

namespace haptoflow::inference {

/// Throws std::invalid_argument unless there is a level for each request.
void requireRoomForLevels(std::span<const SegmentRequest> requests, std::span<const float> levelsMps2);

/// The motion for which the request's level is estimated.
[[nodiscard]] inline const std::array<float, 3>& levelMotionOf(const SegmentRequest& request) noexcept {
    return request.levelMotion ? *request.levelMotion : request.motion;
}

/// The RMS in m/s^2 of a request without a level of its own. `logLevel` is what `source` ("level graph") returned for
/// it. Throws InferenceError for an impossible level.
[[nodiscard]] float levelOf(const SegmentRequest& request, float logLevel, const char* source);

}  // namespace haptoflow::inference
