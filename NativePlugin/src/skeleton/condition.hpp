#pragma once

#include "skeleton/motion_features.hpp"
#include "skeleton/skeleton_layout.hpp"

#include <array>
#include <cstddef>
#include <span>

namespace haptoflow::skeleton {

/// Of each family's rate 0.25 ln(1 + |rate|), then of each rate / (|rate| + 20 Hz): the training's rate_features
/// (Training/haptoflow_training/models/surface_waves.py).
inline constexpr std::size_t rateFeatures = 2 * familyCount;

/// What the perceptrons of skeleton and refinement see: the material embedding, the fine features of the motion, then
/// those of the rates.
using Condition = std::array<float, embeddingSize + fineFeatures + rateFeatures>;

/// How the size of a rate in Hz enters a perceptron: 0.25 ln(1 + |rate|).
[[nodiscard]] float rateSize(double rateHz) noexcept;

/// Of `phases` only the rates count. Numbers that are not finite count as 0. No allocation.
[[nodiscard]] Condition conditionOf(std::span<const float, embeddingSize> embedding, const Motion& motion,
                                    const Phases& phases) noexcept;

}  // namespace haptoflow::skeleton
