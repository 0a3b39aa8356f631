#pragma once

#include "model/model_file.hpp"

#include <array>
#include <cstddef>
#include <optional>

namespace haptoflow::engine {

/// The index of the recorded seed of `label` whose conditions are nearest to the motion: in the logarithms of speed and
/// force, and in direction along the line of motion. Nothing where the model has no seed of that label.
/// Source: HaptoFlow, section 4.1 (first previous waveform retrieved from the training recordings).
[[nodiscard]] std::optional<std::size_t> retrieveSeed(const model::ModelFile& model, std::size_t label,
                                                      const std::array<float, 3>& motion) noexcept;

}  // namespace haptoflow::engine
