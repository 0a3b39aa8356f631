#pragma once

#include "inference/cancellation.hpp"
#include "inference/inference_error.hpp"

#include <cstddef>
#include <memory>

namespace haptoflow::inference {

/// Far above the 0.2 ms that a desktop takes; an emulated machine takes 54 ms.
inline constexpr double defaultProbeLimitMs = 10'000.0;
inline constexpr double maximumProbeLimitMs = 3'600'000.0;
/// Batch size for which the limit is stated; the limit of larger batches is proportionally longer.
inline constexpr std::size_t probeBatch = 8;

/// Conditions under which the loading of a tier stops early.
struct LoadLimits {
    /// Null if the load cannot be cancelled.
    std::shared_ptr<const Cancellation> cancellation{};
    /// Time limit of one probe run of a graph, above 0 to maximumProbeLimitMs.
    double probeLimitMs = defaultProbeLimitMs;

    /// Throws LoadCancelled if the cancellation was requested.
    void check() const {
        if (cancellation != nullptr && cancellation->isCancelled()) {
            throw LoadCancelled("the load was cancelled");
        }
    }
};

}  // namespace haptoflow::inference
