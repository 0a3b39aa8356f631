#pragma once

#include <chrono>
#include <functional>
#include <thread>

namespace haptoflow::bench {

/// Told how much of a measurement is done, 0 to 1.
using Advance = std::function<void(double share)>;

/// Seconds of the clock that all measurements share; it never goes back.
[[nodiscard]] inline double nowSeconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Sleeps until `nowSeconds` has reached the time.
inline void sleepUntil(double seconds) {
    using Clock = std::chrono::steady_clock;
    const auto sinceEpoch = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
    std::this_thread::sleep_until(Clock::time_point(sinceEpoch));
}

/// How long `action` takes, in seconds.
template <typename Action>
[[nodiscard]] double secondsOf(Action&& action) {
    const auto began = std::chrono::steady_clock::now();
    action();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
}

}  // namespace haptoflow::bench
