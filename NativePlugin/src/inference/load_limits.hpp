#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <vector>

namespace haptoflow::inference {

/// ONNX Runtime cannot be used: there is no library at the path, it has another API, or it is older than 1.16.
class RuntimeUnavailable : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// A graph failed while running, or returned a waveform that is not finite.
class InferenceError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// A load was stopped by its Cancellation.
class LoadCancelled : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// A probe run of a tier's graph exceeded its time limit. The message names tier and graph.
class TierTooSlow : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

class CancellationAction;

/// A request to stop loading a model. Any thread.
class Cancellation {
public:
    /// Runs the registered actions. Further calls do nothing.
    void cancel() noexcept;
    [[nodiscard]] bool isCancelled() const noexcept;

private:
    friend class CancellationAction;

    mutable std::mutex mutex_;
    mutable std::vector<const CancellationAction*> actions_;
    bool isCancelled_ = false;
};

/// Registers an action for its lifetime. The action runs once, on the thread that calls `cancel`, or in the constructor
/// if the cancellation was requested before. It must neither block nor throw. A null cancellation never runs it.
class CancellationAction {
public:
    CancellationAction(const Cancellation* cancellation, std::function<void()> action);
    CancellationAction(const CancellationAction&) = delete;
    CancellationAction& operator=(const CancellationAction&) = delete;
    /// Waits for a running action.
    ~CancellationAction();

private:
    friend class Cancellation;

    const Cancellation* cancellation_;
    std::function<void()> action_;
};

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
