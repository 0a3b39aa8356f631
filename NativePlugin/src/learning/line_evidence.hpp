#pragma once

#include "learning/path_windows.hpp"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace haptoflow::learning {

/// (x, y) in cycles per millimetre.
using CyclesPerMm = std::array<double, 2>;

inline constexpr std::size_t directionCount = 120;
/// Of wave numbers: multiples of `stepPerMm` from 0 to a little above 4 cycles per millimetre.
inline constexpr std::size_t stepCount = 402;
inline constexpr double stepPerMm = 0.01;
inline constexpr std::size_t takenHarmonics = 8;
inline constexpr std::size_t fewestWindows = 6;

/// Rows of directions, `stepCount` values each.
using DirectionMap = std::vector<double>;

/// How much speaks for a line of the spectrum at each wave vector.
struct LineEvidence {
    /// Log likelihood ratio of a line there.
    DirectionMap gains;
    /// Its mean power over that of its neighbours.
    DirectionMap ratios;
};

/// Of the direction map's rows, in radians from 0 to below pi.
[[nodiscard]] double angleOf(std::size_t direction);

/// Whether the line of a wave vector lies where it can be told from the hand's own motion and the end of the band.
[[nodiscard]] bool hears(const PathWindow& window, const CyclesPerMm& vector);

/// `known`: vectors whose harmonics count for nothing.
[[nodiscard]] LineEvidence lineEvidence(std::span<const PathWindow> windows, std::span<const CyclesPerMm> known);

}  // namespace haptoflow::learning
