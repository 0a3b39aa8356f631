#pragma once

#include "learning/texture_fit.hpp"

#include <functional>

namespace haptoflow::learning {

/// The factor on an embedding's impulses, 0 to 4, with which the kurtosis of its closed loop is nearest to the
/// recording's. Few labels have impulses, so that an embedding alone says little of them. For a recording without ribs:
/// ribs change the kurtosis too. `progress` receives the completed share, 0 to 1.
[[nodiscard]] float fitImpulseGain(TextureFit& fit, const Embedding& embedding,
                                   const std::function<void(double)>& progress);

}  // namespace haptoflow::learning
