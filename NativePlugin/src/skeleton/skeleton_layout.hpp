#pragma once

#include "dsp/sample_rates.hpp"
#include "model/model_header.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

namespace haptoflow::skeleton {

using dsp::segmentSamples;
using dsp::waveformRateHz;
using model::embeddingSize;

inline constexpr std::size_t filterOrder = model::SkeletonHeader::order;
inline constexpr std::size_t lineHarmonics = model::SkeletonHeader::harmonics;
inline constexpr std::size_t swingHarmonics = model::SkeletonHeader::swingHarmonics;
inline constexpr std::size_t thresholdCount = model::SkeletonHeader::impulseThresholds.size();
/// Number of wave vectors in an embedding. Their x and y components, in cycles per millimetre, are the embedding's last
/// 2 * ribCount numbers; they are zero for a material without ribs.
inline constexpr std::size_t ribCount = 2;
/// Families of waves that the surface's place drives: two of ribs and stick-slip.
inline constexpr std::size_t familyCount = ribCount + 1;
/// Kernels that a threshold's impulses are made of.
inline constexpr std::size_t atomCount = 13;

/// Largest magnitude of what a network is given in unit scale: m/s^2 divided by the level.
inline constexpr float unitLimit = 16.0F;
/// Largest magnitude of the skeleton's own samples in unit scale: a slow tip on concrete is struck with 62.
inline constexpr float skeletonLimit = 64.0F;
/// Largest magnitude of the noise; no number of skeleton::fillStandardNormal reaches it.
inline constexpr float noiseLimit = 9.0F;

/// Turns of the three families at a segment's first sample, then their signed rates in Hz.
using Phases = std::array<float, 2 * familyCount>;

using Segment = std::span<const float, segmentSamples>;

/// The most samples that are synthesised at once.
inline constexpr std::size_t pieceSamples = 32;
using Piece = std::array<float, pieceSamples>;

/// Where the outputs of the perceptron `skeleton` begin: reflections and gain, swing and lines of each family,
/// impulseGains.
namespace output {
inline constexpr std::size_t reflections = 0;
inline constexpr std::size_t gain = filterOrder;
inline constexpr std::size_t swing = gain + 1;
inline constexpr std::size_t lines = swing + familyCount * 2 * swingHarmonics;
inline constexpr std::size_t impulseGains = lines + familyCount * 2 * lineHarmonics;
inline constexpr std::size_t count = impulseGains + 2 * thresholdCount * atomCount;
}  // namespace output

[[nodiscard]] inline float finiteOrZero(float value) noexcept {
    return std::isfinite(value) ? value : 0.0F;
}

/// A sample limited to +-`limit`; what is not a number becomes 0.
[[nodiscard]] inline float limitedOrZero(float sample, float limit) noexcept {
    return std::isnan(sample) ? 0.0F : std::clamp(sample, -limit, limit);
}

/// `waveMps2` divided by the level and limited to +-16. The waves may be the same.
inline void toUnitScale(Segment waveMps2, float levelMps2, std::span<float, segmentSamples> unit) noexcept {
    std::ranges::transform(waveMps2, unit.begin(),
                           [levelMps2](float sample) { return limitedOrZero(sample / levelMps2, unitLimit); });
}

}  // namespace haptoflow::skeleton
