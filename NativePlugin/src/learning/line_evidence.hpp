#pragma once

#include "learning/sliding.hpp"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace haptoflow::learning {

/// (x, y) in cycles per millimetre.
using CyclesPerMm = std::array<double, 2>;

inline constexpr std::size_t directionCount = 120;
/// Wave numbers are multiples of `stepPerMm` from 0 to slightly above 4 cycles per millimetre.
inline constexpr std::size_t stepCount = 402;
inline constexpr double stepPerMm = 0.01;
inline constexpr std::size_t takenHarmonics = 8;
inline constexpr std::size_t minimumWindows = 6;

/// One row of `stepCount` values for each direction.
using DirectionMap = std::vector<double>;

/// Evidence for a spectral line at each wave vector.
struct LineMap {
    /// Log likelihood ratio of a line at the wave vector.
    DirectionMap gains;
    /// Mean power divided by that of the neighbours.
    DirectionMap ratios;
};

struct LineEvidence {
    LineMap all;
    /// Log likelihood ratios beside what all windows of about the same speed have at the same frequency: a resonance
    /// is left out, and a line that few directions show is weaker.
    DirectionMap besideResonances;
};

/// Angle of a row of the direction map, in radians from 0 to below pi.
[[nodiscard]] double angleOf(std::size_t direction);

/// True if the line of a wave vector lies between the hand's own motion and the end of the band in this window.
[[nodiscard]] bool covers(const PathWindow& window, const CyclesPerMm& vector);

/// `known`: vectors whose harmonics are not counted as evidence.
[[nodiscard]] LineEvidence lineEvidence(std::span<const PathWindow> windows, std::span<const CyclesPerMm> known);

}  // namespace haptoflow::learning
