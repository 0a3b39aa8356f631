#pragma once

#include <cstdint>

namespace haptoflow::realtime {

/// From now on every system call of the calling thread is refused (ENOSYS) and counted, for as long as the thread
/// lives: a seccomp filter cannot be taken back. Such a thread ends by `leaveThread`. False where the kernel refuses.
[[nodiscard]] bool trapSystemCalls() noexcept;

/// System calls that trapped threads tried so far, and the number of the last one (-1 for none).
[[nodiscard]] std::uint64_t trappedSystemCalls() noexcept;
[[nodiscard]] long lastTrappedSystemCall() noexcept;

/// Ends the calling thread by the one call that the filter lets through; it can be joined.
[[noreturn]] void leaveThread() noexcept;

}  // namespace haptoflow::realtime
