#pragma once

#include <cstdint>

namespace haptoflow::realtime {

/// During its lifetime, counts the calling thread's allocations, frees, locks, waits and wake-ups. This program
/// interposes the C library's functions with its own, which count and forward the calls.
class WatchedSection {
public:
    WatchedSection() noexcept;
    WatchedSection(const WatchedSection&) = delete;
    WatchedSection& operator=(const WatchedSection&) = delete;
    ~WatchedSection();
};

/// Number of forbidden calls in all watched sections of all threads so far.
[[nodiscard]] std::uint64_t forbiddenCalls() noexcept;
/// Name of the last function called in a watched section; "" if there was none.
[[nodiscard]] const char* lastForbiddenCall() noexcept;

}  // namespace haptoflow::realtime
