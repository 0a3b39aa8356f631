#pragma once

#include "engine/material_library.hpp"
#include "engine/range_law.hpp"

#include <array>
#include <optional>

namespace haptoflow::engine {

/// Where the level of what the network is asked for comes from.
struct LevelRequest {
    /// RMS in m/s^2 to be used instead of the level graph's; empty for the graph's.
    std::optional<float> levelMps2;
    /// What the level graph is asked for, and the gain on its answer.
    std::array<float, 3> motion{};
    float gain = 1.0F;
};

/// A single material that has no level of its own gets the graph's, everything else the mean of what its materials say:
/// the graph's answer to a mean of embeddings may lie beyond the levels of both.
[[nodiscard]] LevelRequest requestLevel(const Ingredients& ingredients, const RangedMotion& ranged) noexcept;

}  // namespace haptoflow::engine
