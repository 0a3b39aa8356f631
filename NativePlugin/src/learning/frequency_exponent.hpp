#pragma once

#include "learning/texture_figures.hpp"
#include "learning/texture_fit.hpp"
#include "model/model_header.hpp"

#include <functional>
#include <span>

namespace haptoflow::learning {

/// The power of the speed with which the spectrum's centre rises on a surface without ribs, 0 to 1: the slope of the
/// centre's log frequency over the log speed, drawn towards the start label's value where speeds are few.
[[nodiscard]] double frequencyExponent(const SpeedBins& bins, std::span<const TextureFigures> recorded,
                                       const model::Label& start);

/// The factor on an embedding's impulses, 0 to 4, with which the kurtosis of its closed loop is nearest to the
/// recording's. Few labels have impulses, so that an embedding alone says little of them. For a recording without ribs:
/// ribs change the kurtosis too. `progress` receives the completed share, 0 to 1.
[[nodiscard]] float fitImpulseGain(TextureFit& fit, const Embedding& embedding,
                                   const std::function<void(double)>& progress);

}  // namespace haptoflow::learning
