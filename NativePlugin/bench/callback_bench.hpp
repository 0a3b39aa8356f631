#pragma once

#include "bench/bench_clock.hpp"
#include "bench/bench_plan.hpp"
#include "bench/subjects.hpp"

#include <nlohmann/json.hpp>

namespace haptoflow::bench {

/// "callback_us": the callback of 1, 2, 8 sliding voices in blocks of 256 frames, beside that of as many voices that
/// write silence. Hot: one thread, no waiting, a round of inference where an update falls due. Paced: in real time,
/// with the engine's worker and a device's thread.
[[nodiscard]] nlohmann::ordered_json measureCallback(const Subjects& subjects, const BenchPlan& plan,
                                                     const Advance& advance);

}  // namespace haptoflow::bench
