#pragma once

#include "learning/closed_loop.hpp"
#include "learning/seed_choice.hpp"

#include <cstdint>
#include <span>

namespace haptoflow::learning {

/// Finds the rib phase of each seed of a ruled material. The position on the surface at which a recording starts is
/// unknown, and so is that of the network's ribs for this embedding. Therefore phases are tried until the network
/// continues a seed's first half like the recording does. Does nothing if the embedding has no wave vectors. Throws
/// inference::InferenceError.
void placeRibs(std::span<LearntSeed> seeds, ClosedLoop& loop, const Embedding& embedding, std::uint64_t seed);

}  // namespace haptoflow::learning
