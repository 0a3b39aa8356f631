#pragma once

#include "bench/bench_clock.hpp"
#include "bench/bench_plan.hpp"
#include "bench/subjects.hpp"

#include <nlohmann/json.hpp>

namespace haptoflow::bench {

/// "idle": what is inferred and how busy a core is while nothing touches, in real time: states at the update rate,
/// blocks from a device. Beside it the same two threads without voice and engine.
[[nodiscard]] nlohmann::ordered_json measureIdle(const Subjects& subjects, const BenchPlan& plan,
                                                 const Advance& advance);

}  // namespace haptoflow::bench
