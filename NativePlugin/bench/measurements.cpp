#include "bench/measurements.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <stdexcept>
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

double nearestRank(const std::vector<double>& sorted, double share) {
    const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(sorted.size())));
    return sorted[std::max<std::size_t>(rank, 1) - 1];
}

}  // namespace

Distribution distributionOf(std::vector<double> values) {
    if (values.empty()) {
        throw std::invalid_argument("a distribution needs at least one value");
    }
    std::ranges::sort(values);
    return {.count = values.size(),
            .p50 = nearestRank(values, 0.5),
            .p99 = nearestRank(values, 0.99),
            .worst = values.back()};
}

double rounded(double value) {
    if (value == 0.0 || !std::isfinite(value)) {
        return value;
    }
    constexpr int digits = 6;
    const int shift = digits - 1 - static_cast<int>(std::floor(std::log10(std::abs(value))));
    const double power = std::pow(10.0, std::abs(shift));
    return shift >= 0 ? std::round(value * power) / power : std::round(value / power) * power;
}

nlohmann::ordered_json toJson(const Distribution& distribution, double scale) {
    return {{"count", distribution.count},
            {"p50", rounded(distribution.p50 * scale)},
            {"p99", rounded(distribution.p99 * scale)},
            {"worst", rounded(distribution.worst * scale)}};
}

nlohmann::ordered_json ratioOf(double numerator, double denominator) {
    if (denominator == 0.0) {
        return nullptr;
    }
    return rounded(numerator / denominator);
}

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
