#pragma once

#include <functional>
#include <mutex>
#include <vector>

namespace haptoflow::inference {

class CancellationAction;

/// A request to stop loading a model. Any thread.
class Cancellation {
public:
    Cancellation() = default;
    Cancellation(const Cancellation&) = delete;
    Cancellation& operator=(const Cancellation&) = delete;
    ~Cancellation() = default;

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

}  // namespace haptoflow::inference
