#include "learning/thread_clock.hpp"

#if defined(_WIN32)
#include <windows.h>
#else
#include <ctime>
#endif

#include <chrono>

namespace haptoflow::learning {

double threadSeconds() noexcept {
#if defined(_WIN32)
    constexpr double secondsPerTick = 1e-7;
    FILETIME created;
    FILETIME ended;
    FILETIME kernel;
    FILETIME user;
    if (GetThreadTimes(GetCurrentThread(), &created, &ended, &kernel, &user) != 0) {
        const auto ticks = [](const FILETIME& time) {
            return static_cast<double>(time.dwHighDateTime) * 4294967296.0 + static_cast<double>(time.dwLowDateTime);
        };
        return secondsPerTick * (ticks(kernel) + ticks(user));
    }
#elif defined(CLOCK_THREAD_CPUTIME_ID)
    timespec time{};
    if (clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time) == 0) {
        return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
    }
#endif
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace haptoflow::learning
