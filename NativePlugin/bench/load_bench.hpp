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
    /// A model of the paper's architecture; empty for none.
    std::filesystem::path paperModel;
};

/// Opens the library, the models and the engine, and adds the cost of that to `report`: "memory_mib" and its parts,
/// "load_ms" and its parts. Memory can only be measured at the first opening in a process, so that this must run before
/// everything else.
/// Throws model::ModelError, inference::RuntimeUnavailable, inference::InferenceError.
[[nodiscard]] Subjects openSubjects(const SubjectFiles& files, std::uint64_t seed, nlohmann::ordered_json& report);

/// Opens the model and creates its engine repeatedly, compared with plain reading of the same file; completes "load".
void measureLoads(const SubjectFiles& files, const Subjects& subjects, const BenchPlan& plan, const Advance& advance,
                  nlohmann::ordered_json& report);

}  // namespace haptoflow::bench
