#include "bench/process_usage.hpp"

#if defined(_WIN32)
#ifndef NOMINMAX
#define NOMINMAX
#endif
#include <windows.h>

#include <psapi.h>
#elif defined(__APPLE__)
#include <mach/mach.h>
#include <ctime>
#else
#include <unistd.h>
#include <ctime>
#include <fstream>
#endif

namespace haptoflow::bench {
namespace {

constexpr double mebibyte = 1024.0 * 1024.0;

}  // namespace

#if defined(_WIN32)

double processCpuSeconds() {
    FILETIME created{};
    FILETIME ended{};
    FILETIME kernel{};
    FILETIME user{};
    if (GetProcessTimes(GetCurrentProcess(), &created, &ended, &kernel, &user) == 0) {
        return 0.0;
    }
    // Both in units of 100 ns.
    const auto seconds = [](const FILETIME& time) {
        return (static_cast<double>(time.dwHighDateTime) * 4294967296.0 + static_cast<double>(time.dwLowDateTime)) *
               1e-7;
    };
    return seconds(kernel) + seconds(user);
}

double residentMebibytes() {
    PROCESS_MEMORY_COUNTERS counters{};
    if (K32GetProcessMemoryInfo(GetCurrentProcess(), &counters, sizeof(counters)) == 0) {
        return 0.0;
    }
    return static_cast<double>(counters.WorkingSetSize) / mebibyte;
}

#else

double processCpuSeconds() {
    timespec spent{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &spent);
    return static_cast<double>(spent.tv_sec) + 1e-9 * static_cast<double>(spent.tv_nsec);
}

#if defined(__APPLE__)

double residentMebibytes() {
    mach_task_basic_info info{};
    mach_msg_type_number_t count = MACH_TASK_BASIC_INFO_COUNT;
    const kern_return_t status =
        task_info(mach_task_self(), MACH_TASK_BASIC_INFO, reinterpret_cast<task_info_t>(&info), &count);
    return status == KERN_SUCCESS ? static_cast<double>(info.resident_size) / mebibyte : 0.0;
}

#else

double residentMebibytes() {
    std::ifstream file("/proc/self/statm");
    double sizePages = 0.0;
    double residentPages = 0.0;
    file >> sizePages >> residentPages;
    return residentPages * static_cast<double>(sysconf(_SC_PAGESIZE)) / mebibyte;
}

#endif
#endif

}  // namespace haptoflow::bench
