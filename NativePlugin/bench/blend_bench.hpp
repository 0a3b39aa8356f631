#pragma once

#include "bench/bench_clock.hpp"
#include "bench/bench_plan.hpp"
#include "bench/subjects.hpp"

#include <nlohmann/json.hpp>

namespace haptoflow::bench {

/// "blends": what a contact state of 1, 2 and 4 materials costs the main thread, the worker and a block of the
/// callback, while a hand slides. All take part in every update, in random order.
[[nodiscard]] nlohmann::ordered_json measureBlends(const Subjects& subjects, const BenchPlan& plan,
                                                   const Advance& advance);

}  // namespace haptoflow::bench
