#include "inference/time_limit.hpp"

#include <utility>

namespace haptoflow::inference {

TimeLimit::TimeLimit(double milliseconds, std::function<void()> action)
    : end_(std::chrono::steady_clock::now() +
           std::chrono::microseconds(static_cast<std::chrono::microseconds::rep>(1000.0 * milliseconds))) {
    timer_ = std::thread([this, act = std::move(action)] {
        std::unique_lock lock(mutex_);
        if (!changed_.wait_until(lock, end_, [this] { return isOver_; })) {
            act();
        }
    });
}

TimeLimit::~TimeLimit() {
    {
        const std::lock_guard lock(mutex_);
        isOver_ = true;
    }
    changed_.notify_all();
    timer_.join();
}

}  // namespace haptoflow::inference
