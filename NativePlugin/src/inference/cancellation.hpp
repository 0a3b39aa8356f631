#pragma once

#include <functional>
#include <mutex>
#include <vector>

namespace haptoflow::inference {

class CancellationAction;

/// Asks whoever loads to stop. Any thread.
class Cancellation {
public:
    Cancellation() = default;
    Cancellation(const Cancellation&) = delete;
    Cancellation& operator=(const Cancellation&) = delete;
    ~Cancellation() = default;

    /// Runs the actions that are registered; further calls do nothing.
    void cancel() noexcept;
    [[nodiscard]] bool isCancelled() const noexcept;

private:
    friend class CancellationAction;

    mutable std::mutex mutex_;
    mutable std::vector<const CancellationAction*> actions_;
    bool isCancelled_ = false;
};

/// While it lives, its action runs once when the cancellation comes, on the thread that cancels; at once where it came
/// already. The action must neither block nor throw. A null cancellation never comes.
class CancellationAction {
public:
    CancellationAction(const Cancellation* cancellation, std::function<void()> action);
    CancellationAction(const CancellationAction&) = delete;
    CancellationAction& operator=(const CancellationAction&) = delete;
    /// Waits for the action where it is running.
    ~CancellationAction();

private:
    friend class Cancellation;

    const Cancellation* cancellation_;
    std::function<void()> action_;
};

}  // namespace haptoflow::inference
