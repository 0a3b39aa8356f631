#pragma once

#include "bench/bench_clock.hpp"
#include "bench/bench_plan.hpp"

#include <nlohmann/json.hpp>

#include <cstdint>

namespace haptoflow::bench {

/// "contact": one frame of a tip that slides over scenes of 10 to 10,000 surfaces at rest, as close to each other in a
/// large scene as in a small one; boxes, spheres and capsules in turn.
[[nodiscard]] nlohmann::ordered_json measureContact(std::uint64_t seed, const BenchPlan& plan, const Advance& advance);

}  // namespace haptoflow::bench
