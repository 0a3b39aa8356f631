#pragma once

#include "engine/material_library.hpp"
#include "engine/range_law.hpp"

#include <array>
#include <optional>

namespace haptoflow::engine {

/// Source of a segment's level.
struct LevelRequest {
    /// RMS in m/s^2 that replaces the level graph's; empty for the graph's.
    std::optional<float> levelMps2;
    /// Motion input of the level graph, and a gain on its result.
    std::array<float, 3> motion{};
    float gain = 1.0F;
};

/// A single material without its own level uses the level graph. A blend uses the mean of its materials' levels,
/// because the graph's level for a mean of embeddings can lie outside the range of their levels.
[[nodiscard]] LevelRequest requestLevel(const Ingredients& ingredients, const RangedMotion& ranged) noexcept;

}  // namespace haptoflow::engine
