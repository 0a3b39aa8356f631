#pragma once

#include "skeleton/motion_features.hpp"
#include "skeleton/skeleton_layout.hpp"

#include <array>
#include <span>

namespace haptoflow::skeleton {

/// Signed rates in Hz at which a tip crosses the ribs of an embedding, one for each wave vector: k . v.
[[nodiscard]] std::array<double, ribCount> ribRatesHz(std::span<const float, embeddingSize> embedding, double vxMps,
                                                      double vyMps) noexcept;

/// Phases of a request: the turns of the two families of ribs, and the rates of the embedding at the motion. The third
/// family stands still.
[[nodiscard]] Phases phasesOf(std::span<const float, embeddingSize> embedding, const Motion& motion,
                              const std::array<float, ribCount>& turns) noexcept;

/// Turns as a phase in [0, 1).
[[nodiscard]] float wrapped(double turns) noexcept;

/// The phases a number of waveform samples later, or earlier for a negative number, at the same rates.
[[nodiscard]] Phases advanced(const Phases& phases, double samples) noexcept;

}  // namespace haptoflow::skeleton
