#pragma once

#include "learning/closed_loop.hpp"
#include "learning/seed_choice.hpp"

#include <cstdint>
#include <span>

namespace haptoflow::learning {

/// Gives each seed of a ruled material its rib phase: nobody knows where on the surface a recording began, nor where
/// the network's ribs of this embedding do, so that phases are tried until the network goes on from a seed's first half
/// as the recording does. Without wave vectors in the embedding nothing is done. Throws inference::InferenceError.
void placeRibs(std::span<LearntSeed> seeds, ClosedLoop& loop, const Embedding& embedding, std::uint64_t seed);

}  // namespace haptoflow::learning
