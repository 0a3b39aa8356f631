#pragma once

#include "learning/level_law.hpp"
#include "learning/texture_fit.hpp"

#include <span>

namespace haptoflow::learning {

/// The law with which the closed loop, behind the tone, is as loud as the recording at every speed: the same law is
/// fitted to both on the same stretches, and the difference is added. `law` is what the loop's waves of unit level were
/// made for.
[[nodiscard]] LevelLaw calibratedLevel(const LevelLaw& law, const recordings::PreparedRecording& recording,
                                       const Sliding& sliding, std::span<const LoopStretch> stretches,
                                       const model::ToneTable& tone, const ExponentPrior& prior);

}  // namespace haptoflow::learning
