#pragma once

#include "skeleton/motion_features.hpp"
#include "skeleton/skeleton_layout.hpp"

#include <array>
#include <span>

namespace haptoflow::skeleton {

/// What the perceptrons of skeleton and refinement see: the material embedding, then the fine features of the motion.
using Condition = std::array<float, embeddingSize + fineFeatures>;

/// Numbers that are not finite count as 0. No allocation.
[[nodiscard]] Condition conditionOf(std::span<const float, embeddingSize> embedding, const Motion& motion) noexcept;

}  // namespace haptoflow::skeleton
