#pragma once

#include "learning/texture_figures.hpp"
#include "model/model_header.hpp"

#include <span>

namespace haptoflow::learning {

/// How the spectrum's centre moves with speed, for a surface without ribs, 0 to 1: the slope of its log frequency over
/// the log speed, combined with the start label's value.
[[nodiscard]] double frequencyExponent(const SpeedBins& bins, std::span<const TextureFigures> recorded,
                                       const model::Label& start);

}  // namespace haptoflow::learning
