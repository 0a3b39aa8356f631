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

/// Makes every further system call of the calling thread fail with ENOSYS and counts it. A seccomp filter cannot be
/// removed, so such a thread must end with `leaveThread`. Returns false if the kernel does not allow the filter.
[[nodiscard]] bool trapSystemCalls() noexcept;

/// Number of system calls that trapped threads attempted, and the number of the last one (-1 for none).
[[nodiscard]] std::uint64_t trappedSystemCalls() noexcept;
[[nodiscard]] long lastTrappedSystemCall() noexcept;

/// Ends the calling thread with the only system call that the filter allows. The thread can be joined.
[[noreturn]] void leaveThread() noexcept;

}  // namespace haptoflow::realtime
