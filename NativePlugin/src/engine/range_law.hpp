#pragma once

#include "engine/material.hpp"
#include "model/model_header.hpp"

#include <array>

namespace haptoflow::engine {

/// What the network is asked for, and what is done to its answer, where the hand leaves the recorded range.
struct RangedMotion {
    /// vx, vy in m/s and force in N, inside the recorded range: what the network is asked for, and what the level is.
    std::array<float, 3> motion{};
    std::array<float, 3> levelMotion{};
    /// (v / v_edge)^p (F / F_edge)^q, 1 inside the range.
    double levelGain = 1.0;
    /// How much faster the waveform is read: min(4, (v / v_edge)^gamma), 1 inside the range.
    double readingRate = 1.0;
};

/// Clamps the motion to the model's range and continues level and frequency beyond it by the label's own exponents.
/// Continuous in speed and force; the gain is limited to 16. Features `spatialScale` times as large are those of a
/// speed so much lower; the level is that of the speed as it is.
[[nodiscard]] RangedMotion applyRangeLaw(const model::ModelHeader& header, const Material& material,
                                         const std::array<float, 2>& velocityMps, float forceNewtons,
                                         float spatialScale = 1.0F) noexcept;

}  // namespace haptoflow::engine
