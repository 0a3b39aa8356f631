#include "inference/time_limit.hpp"

#include <chrono>
#include <utility>

namespace haptoflow::inference {

TimeLimit::TimeLimit(double milliseconds, std::function<void()> action) {
    const auto end = std::chrono::steady_clock::now() +
                     std::chrono::microseconds(static_cast<std::chrono::microseconds::rep>(1000.0 * milliseconds));
    timer_ = std::thread([this, end, act = std::move(action)] {
        std::unique_lock lock(mutex_);
        if (!changed_.wait_until(lock, end, [this] { return isOver_; })) {
            hasPassed_ = true;
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

bool TimeLimit::hasPassed() const {
    const std::lock_guard lock(mutex_);
    return hasPassed_;
}

}  // namespace haptoflow::inference
