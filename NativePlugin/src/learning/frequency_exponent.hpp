#pragma once

#include "learning/texture_figures.hpp"
#include "model/model_header.hpp"

#include <span>

namespace haptoflow::learning {

/// The power of the speed with which the spectrum's centre rises on a surface without ribs, 0 to 1: the slope of the
/// centre's log frequency over the log speed, drawn towards the start label's value where speeds are few.
[[nodiscard]] double frequencyExponent(const SpeedBins& bins, std::span<const TextureFigures> recorded,
                                       const model::Label& start);

}  // namespace haptoflow::learning
