#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace haptoflow::inference {

/// Runs an action on its own thread once a time has passed, unless it was destroyed before. For loading only, because
/// it starts a thread.
class TimeLimit {
public:
    /// The action must neither block nor throw. Throws std::system_error.
    TimeLimit(double milliseconds, std::function<void()> action);
    TimeLimit(const TimeLimit&) = delete;
    TimeLimit& operator=(const TimeLimit&) = delete;
    /// Waits for a running action. Afterwards the action never runs.
    ~TimeLimit();

    /// By the clock: on a busy machine the thread may not have run yet.
    [[nodiscard]] bool hasPassed() const { return std::chrono::steady_clock::now() >= end_; }

private:
    std::chrono::steady_clock::time_point end_;
    std::mutex mutex_;
    std::condition_variable changed_;
    bool isOver_ = false;
    std::thread timer_;
};

}  // namespace haptoflow::inference
