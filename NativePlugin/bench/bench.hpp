#pragma once

#include "bench/bench_plan.hpp"
#include "bench/subjects.hpp"

#include <nlohmann/json.hpp>

#include <array>
#include <cstdint>
#include <functional>
#include <iosfwd>
#include <string>
#include <string_view>
#include <vector>

namespace haptoflow::bench {

/// Measurements that can be run alone. Loading and memory are always measured, because all others need the open model.
inline constexpr std::array<std::string_view, 6> measurementNames{"callback",  "effects", "latency",
                                                                  "inference", "voices",  "idle"};

struct BenchOptions {
    SubjectFiles files;
    BenchPlan plan;
    /// Names from measurementNames; empty for all.
    std::vector<std::string> only;
    std::uint64_t seed = 1;
    /// HaptoFlow's version.
    std::string version;
};

/// Receives the name of the current measurement and the completed share of the whole, 0 to 1.
using BenchProgress = std::function<void(double share, std::string_view what)>;

/// Runs the measurements and returns the results as one object, bench.json: see Documentation~/live-engine.md. Takes
/// the plan's time, because paced measurements run in real time. A measurement that was not possible has no key;
/// "notes" says why. Throws MeasurementError, model::ModelError, inference::RuntimeUnavailable,
/// inference::InferenceError.
[[nodiscard]] nlohmann::ordered_json runBench(const BenchOptions& options, const BenchProgress& progress);

/// Prints the report of `runBench` for reading: one table for each measurement in it.
void printTables(std::ostream& stream, const nlohmann::ordered_json& report);

}  // namespace haptoflow::bench
