#pragma once

#include "bench/bench_clock.hpp"
#include "bench/bench_plan.hpp"
#include "bench/subjects.hpp"

#include <nlohmann/json.hpp>

namespace haptoflow::bench {

/// {"callback_events_us": [...]}: what the callback's block costs at which something happens, apart from ordinary
/// blocks: touch-down, lift-off, pause, resumption, panic. A row for each device; every voice of a row has its event in
/// the same block. Each kind is told with its p50 over that of the row's ordinary blocks.
[[nodiscard]] nlohmann::ordered_json measureEventBlocks(const Subjects& subjects, const BenchPlan& plan,
                                                        const Advance& advance);

}  // namespace haptoflow::bench
