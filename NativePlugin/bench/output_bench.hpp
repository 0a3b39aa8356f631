#pragma once

#include "bench/bench_clock.hpp"
#include "bench/bench_plan.hpp"
#include "bench/subjects.hpp"

#include <nlohmann/json.hpp>

namespace haptoflow::bench {

/// "outputs": what each kind of output costs a frame of the display on top of the network: a voice at the output's rate
/// and what is made of its wave. The vendors' calls and the C# queues are not in it.
[[nodiscard]] nlohmann::ordered_json measureOutputs(const Subjects& subjects, const BenchPlan& plan,
                                                    const Advance& advance);

}  // namespace haptoflow::bench
