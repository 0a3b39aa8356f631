#pragma once

#include "inference/cancellation.hpp"
#include "inference/inference_error.hpp"

#include <cstddef>
#include <memory>

namespace haptoflow::inference {

/// Generous: an emulated machine takes 54 ms where a desktop takes 0.2.
inline constexpr double usualProbeLimitMs = 10'000.0;
inline constexpr double largestProbeLimitMs = 3'600'000.0;
/// Requests in one probe run that the limit is meant for; longer batches have in proportion longer.
inline constexpr std::size_t probeBatch = 8;

/// What ends the loading of a tier before its time.
struct LoadLimits {
    /// Null for a load that nobody cancels.
    std::shared_ptr<const Cancellation> cancellation{};
    /// What one probe run of a graph may take, above 0 to largestProbeLimitMs.
    double probeLimitMs = usualProbeLimitMs;

    /// Throws LoadCancelled.
    void check() const {
        if (cancellation != nullptr && cancellation->isCancelled()) {
            throw LoadCancelled("the load was cancelled");
        }
    }
};

}  // namespace haptoflow::inference
