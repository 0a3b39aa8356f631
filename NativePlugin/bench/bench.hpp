#pragma once

#include "bench/bench_plan.hpp"
#include "bench/load_bench.hpp"

#include <nlohmann/json.hpp>

#include <iosfwd>
#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace haptoflow::bench {

/// What can be measured alone. Loading and memory are always measured: everything else needs what they open.
inline constexpr std::array<std::string_view, 10> measurementNames{
    "callback", "events", "effects", "blends", "outputs", "latency", "inference", "voices", "idle", "contact"};

struct BenchOptions {
    SubjectFiles files;
    BenchPlan plan;
    /// Of measurementNames; empty for all.
    std::vector<std::string> only;
    std::uint64_t seed = 1;
    /// Of HaptoFlow.
    std::string version;
};

/// Told what is being measured and how much of the whole is done, 0 to 1.
using BenchProgress = std::function<void(double share, std::string_view what)>;

/// Measures, and says everything in one object: bench.json, see Documentation~/benchmarks.md. Takes the plan's time,
/// and real time for what is paced. What could not be measured has no key; "notes" says why.
/// Throws MeasurementError, model::ModelError, inference::RuntimeUnavailable, inference::InferenceError.
[[nodiscard]] nlohmann::ordered_json runBench(const BenchOptions& options, const BenchProgress& progress);

/// Prints the report of `runBench` for reading: one table for each measurement in it.
void printTables(std::ostream& stream, const nlohmann::ordered_json& report);

}  // namespace haptoflow::bench
