#pragma once

#include "model/model_file.hpp"

#include <array>
#include <cstddef>
#include <span>

namespace haptoflow::engine {

/// The recorded seed of `label` whose conditions are nearest to the motion: in the logarithms of speed and force, and
/// in direction along the line of motion. 400 samples of RMS 1; empty where the model has no seed of that label.
/// Source: HaptoFlow, section 4.1 (first previous waveform retrieved from the training recordings).
[[nodiscard]] std::span<const float> retrieveSeed(const model::ModelFile& model, std::size_t label,
                                                  const std::array<float, 3>& motion) noexcept;

}  // namespace haptoflow::engine
