#pragma once

#include "inference/segment_generator.hpp"

#include <array>
#include <cstddef>
#include <span>

namespace haptoflow::inference {

/// Returns `batch`. Throws std::invalid_argument outside 1 to maximumBatchSize.
[[nodiscard]] std::size_t requireBatch(std::size_t batch);

/// Throws std::invalid_argument that begins with `what` unless `found` is `expected`.
void requireSize(std::size_t found, std::size_t expected, const char* what);

/// Throws InferenceError that names `source` if a sample is not finite.
void requireFinite(std::span<const float> segments, const char* source);

/// Calls `action(first, count)` for consecutive parts of at most `maximum` elements.
template <typename Action>
void inBatches(std::size_t total, std::size_t maximum, Action action) {
    for (std::size_t first = 0; first < total; first += maximum) {
        action(first, total - first < maximum ? total - first : maximum);
    }
}

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
