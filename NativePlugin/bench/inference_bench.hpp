#pragma once

#include "bench/bench_clock.hpp"
#include "bench/bench_plan.hpp"
#include "bench/subjects.hpp"

#include <nlohmann/json.hpp>

namespace haptoflow::bench {

/// "inference_ms": one segment by every tier of the model, hot and one every 1/72 s, on one thread; where the paper's
/// architecture is there, "paper_architecture_ms" and "speedup_vs_paper_architecture" from the same run. All run in
/// blocks in random order, so that a slow second of the machine falls on everybody.
[[nodiscard]] nlohmann::ordered_json measureInference(const Subjects& subjects, const BenchPlan& plan,
                                                      const Advance& advance);

/// "voices": the segments of so many voices in one batch, beside as many batches of one, by the tier "standard".
[[nodiscard]] nlohmann::ordered_json measureVoices(const Subjects& subjects, const BenchPlan& plan,
                                                   const Advance& advance);

}  // namespace haptoflow::bench
