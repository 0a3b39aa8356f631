#pragma once

#include "engine/material.hpp"
#include "engine/material_library.hpp"
#include "model/model_header.hpp"

#include <array>
#include <optional>

namespace haptoflow::engine {

/// A motion clamped to the trained range, with the gain and the reading rate that extend the result beyond it.
struct RangedMotion {
    /// Inputs of the network and of the level: vx, vy in m/s and force in N, inside the trained range.
    std::array<float, 3> motion{};
    std::array<float, 3> levelMotion{};
    /// (v / v_edge)^p (F / F_edge)^q; 1 inside the range.
    double levelGain = 1.0;
    /// Speed at which the waveform is read: min(4, (v / v_edge)^gamma); 1 inside the range.
    double readingRate = 1.0;
};

/// Clamps the motion to the trained range and extends level and frequency beyond it with the label's exponents.
/// Continuous in speed and force; the gain is limited to 16. The network's motion uses the speed divided by
/// `spatialScale`, the level the actual speed.
[[nodiscard]] RangedMotion applyRangeLaw(const model::ModelHeader& header, const Material& material,
                                         const std::array<float, 2>& velocityMps, float forceNewtons,
                                         float spatialScale = 1.0F) noexcept;

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
