#pragma once

#include "bench/bench_clock.hpp"
#include "bench/bench_plan.hpp"
#include "bench/subjects.hpp"

#include <nlohmann/json.hpp>

#include <filesystem>

namespace haptoflow::bench {

struct SubjectFiles {
    std::filesystem::path runtimeLibrary;
    std::filesystem::path model;
    /// Empty for none.
    std::filesystem::path paperModel;
};

/// Opens what is measured, and notes on the way what opening costs: "memory_mib" and its parts, "load_ms" and its
/// parts. Only the first opening of a process shows what memory it takes: this comes before anything else.
/// Throws model::ModelError, inference::RuntimeUnavailable, inference::InferenceError.
[[nodiscard]] Subjects openSubjects(const SubjectFiles& files, std::uint64_t seed, nlohmann::ordered_json& report);

/// Opens the model and makes its engine again and again, beside plain reading of the same file; completes "load".
void measureLoads(const SubjectFiles& files, const Subjects& subjects, const BenchPlan& plan, const Advance& advance,
                  nlohmann::ordered_json& report);

}  // namespace haptoflow::bench
