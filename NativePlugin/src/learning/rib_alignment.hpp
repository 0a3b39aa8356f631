#pragma once

#include "learning/prepared_recording.hpp"
#include "learning/texture_figures.hpp"

#include <array>
#include <complex>
#include <span>
#include <vector>

namespace haptoflow::learning {

/// How far the tip has travelled along each wave vector at each sample of a recording, in turns, from the recording's
/// beginning; empty without ribs.
[[nodiscard]] std::vector<RibWay> ribWays(const PreparedRecording& recording,
                                          std::span<const float, 2 * inference::ribCount> waveVectors);

/// For each wave vector the fundamental's complex amplitude: a wave of ribs goes as cos(2 pi turns + its angle).
using RibFundamentals = std::array<std::complex<double>, inference::ribCount>;

/// Of a stretch, behind a Hann window. `ways`: one for each sample.
[[nodiscard]] RibFundamentals ribFundamentals(std::span<const float> wave, std::span<const RibWay> ways);

/// The phases, from 0 to below 1, at which the network draws a fundamental where the recording has it. `way`: of the
/// sample in question; `recorded`: of the stretch around it; `generated`: the network's own, of phases that begin at 0.
[[nodiscard]] std::array<double, inference::ribCount> alignedPhase(const RibWay& way, const RibFundamentals& recorded,
                                                                   const RibFundamentals& generated);

}  // namespace haptoflow::learning
