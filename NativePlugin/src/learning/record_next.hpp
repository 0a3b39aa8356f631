#pragma once

#include "learning/level_law.hpp"
#include "learning/sliding.hpp"

#include <string>

namespace haptoflow::learning {

/// One sentence: what to record next so that the material gains most. Empty if nothing much is missing.
///
/// Compared are the ends of what hands do (20 to 300 mm/s, 0.3 to 2 N) that the recording lacks: how uncertain the
/// level is there, from how much labels differ in the exponents that take the recording's place.
[[nodiscard]] std::string recordNext(const Sliding& sliding, const ExponentPrior& prior);

}  // namespace haptoflow::learning
