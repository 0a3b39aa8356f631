#pragma once

#include "learning/prepared_recording.hpp"
#include "learning/sliding.hpp"
#include "learning/tone_fit.hpp"
#include "model/model_header.hpp"

#include <array>
#include <span>
#include <vector>

namespace haptoflow::learning {

struct LearntSeed {
    std::array<double, 2> velocityMps{};
    double forceNewtons = 0.0;
    /// With an RMS of 1, so that the tone makes the recording's sound of it.
    std::array<float, model::seedSamples> samples{};
    /// Sample of the recording at which it begins.
    std::size_t start = 0;
};

inline constexpr std::size_t mostLearntSeeds = 8;

/// Stretches of the recording at speeds, forces and directions as different as it has them.
[[nodiscard]] std::vector<LearntSeed> chooseSeeds(const PreparedRecording& recording, const Sliding& sliding,
                                                  std::span<const float> unitWave, const model::ToneTable& tone);

}  // namespace haptoflow::learning
