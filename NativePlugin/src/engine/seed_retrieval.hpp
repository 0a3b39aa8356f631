#pragma once

#include "engine/known_material.hpp"

#include <array>
#include <span>

namespace haptoflow::engine {

/// The seed whose conditions are nearest to the motion: in the logarithms of speed and force, and in direction along
/// the line of motion. Null where there is none. Source: HaptoFlow, section 4.1 (first previous waveform retrieved from
/// the training recordings).
[[nodiscard]] const Seed* retrieveSeed(std::span<const Seed> seeds, const std::array<float, 3>& motion) noexcept;

}  // namespace haptoflow::engine
