#pragma once

#include <chrono>
#include <functional>
#include <thread>

namespace haptoflow::bench {

/// Receives the completed share of a measurement, 0 to 1.
using Advance = std::function<void(double share)>;

/// Time in seconds of the monotonic clock that all measurements use.
[[nodiscard]] inline double nowSeconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Sleeps until `nowSeconds` has reached `seconds`.
inline void sleepUntil(double seconds) {
    using Clock = std::chrono::steady_clock;
    const auto sinceEpoch = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
    std::this_thread::sleep_until(Clock::time_point(sinceEpoch));
}

/// Runs `action` and returns the time that it took, in seconds.
template <typename Action>
[[nodiscard]] double secondsOf(Action&& action) {
    const auto began = std::chrono::steady_clock::now();
    action();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
}

}  // namespace haptoflow::bench
