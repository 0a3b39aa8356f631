#pragma once

#include "bench/bench_clock.hpp"
#include "bench/bench_plan.hpp"
#include "bench/subjects.hpp"

#include <nlohmann/json.hpp>

namespace haptoflow::bench {

/// "effects": what each effect costs a block of the callback where it is asked for, and that it does not run where it
/// is not. A hand slides, lands five times a second and crosses from label to label ten times a second.
[[nodiscard]] nlohmann::ordered_json measureEffects(const Subjects& subjects, const BenchPlan& plan,
                                                    const Advance& advance);

}  // namespace haptoflow::bench
