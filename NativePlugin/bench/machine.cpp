#include "bench/machine.hpp"

#include "bench/distribution.hpp"

#include <array>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <thread>

#if defined(__APPLE__)
#include <mach/mach.h>
#include <sys/sysctl.h>
#include <sys/utsname.h>
#else
#include <sys/utsname.h>
#include <unistd.h>
#endif

namespace haptoflow::bench {
namespace {

constexpr double mebibyte = 1024.0 * 1024.0;

#if defined(__APPLE__)

std::string processorName() {
    std::array<char, 256> name{};
    std::size_t bytes = name.size() - 1;
    return sysctlbyname("machdep.cpu.brand_string", name.data(), &bytes, nullptr, 0) == 0 ? name.data() : "";
}

#else

std::string processorName() {
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);) {
        const std::size_t colon = line.find(": ");
        if (line.starts_with("model name") && colon != std::string::npos) {
            return line.substr(colon + 2);
        }
    }
    return "";
}

#endif

std::string systemName() {
    utsname names{};
    return uname(&names) == 0 ? std::string(names.sysname) + ' ' + names.release + ' ' + names.machine : "";
}

std::string orUnknown(const std::string& text) {
    return text.empty() ? "unknown" : text;
}

}  // namespace

nlohmann::ordered_json machineWords(const std::string& onnxRuntimeVersion) {
#if defined(__clang__)
    const std::string compiler = std::string("clang ") + __clang_version__;
#else
    const std::string compiler = std::string("gcc ") + __VERSION__;
#endif
#if defined(NDEBUG)
    const char* const build = "release";
#else
    const char* const build = "with assertions";
#endif
    return {{"processor", orUnknown(processorName())},
            {"cores", std::thread::hardware_concurrency()},
            {"system", orUnknown(systemName())},
            {"compiler", compiler},
            {"build", build},
            {"onnxruntime", onnxRuntimeVersion}};
}

nlohmann::ordered_json loadAverage() {
    double average = 0.0;
    if (getloadavg(&average, 1) != 1) {
        return nullptr;
    }
    return rounded(average);
}

std::string today() {
    const std::time_t now = std::time(nullptr);
    std::tm date{};
    gmtime_r(&now, &date);
    std::array<char, 16> text{};
    std::strftime(text.data(), text.size(), "%Y-%m-%d", &date);
    return text.data();
}

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

}  // namespace haptoflow::bench
