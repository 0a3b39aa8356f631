#pragma once

#include "skeleton/skeleton_layout.hpp"

#include <array>
#include <cstddef>
#include <span>

namespace haptoflow::skeleton {

/// vx, vy in m/s along the surface's tangent axes, force in N.
using Motion = std::array<float, 3>;

/// How speed and force enter the networks: ln((speed + 0.5 mm/s) / 60 mm/s) and ln(force + 0.02 N). Negative forces
/// count as 0.
struct LogMotion {
    double speed = 0.0;
    double force = 0.0;
};
[[nodiscard]] LogMotion logMotionOf(const Motion& motion) noexcept;

/// Features that resolve speeds 1 % apart, as a ruled surface needs; and those for levels, which change slowly.
inline constexpr std::size_t fineFeatures = 18;
inline constexpr std::size_t smoothFeatures = 12;

/// Half the logarithms, direction, direction of twice the angle, sine and cosine of harmonics of log speed, speed and a
/// fifth of the force: the training's MotionFeatures (Training/haptoflow_training/models/conditioning.py).
[[nodiscard]] std::array<float, fineFeatures> fineFeaturesOf(const Motion& motion) noexcept;
[[nodiscard]] std::array<float, smoothFeatures> smoothFeaturesOf(const Motion& motion) noexcept;

/// Signed rates in Hz at which a tip crosses the ribs of an embedding, one for each wave vector: k . v.
[[nodiscard]] std::array<double, ribCount> ribRatesHz(std::span<const float, embeddingSize> embedding, double vxMps,
                                                      double vyMps) noexcept;

/// Phases of a request: the turns of the two families of ribs, and the rates of the embedding at the motion. The third
/// family stands still.
[[nodiscard]] Phases phasesOf(std::span<const float, embeddingSize> embedding, const Motion& motion,
                              const std::array<float, ribCount>& cycles) noexcept;

/// Turns as a phase in [0, 1).
[[nodiscard]] float wrapped(double cycles) noexcept;

/// The phases a number of waveform samples later, or earlier for a negative number, at the same rates.
[[nodiscard]] Phases advanced(const Phases& phases, double samples) noexcept;

/// Of each family's rate 0.25 ln(1 + |rate|), then of each rate / (|rate| + 20 Hz): the training's rate_features
/// (Training/haptoflow_training/models/label_embedding.py).
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
