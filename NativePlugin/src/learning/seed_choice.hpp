#pragma once

#include "inference/segment_generator.hpp"
#include "learning/sliding.hpp"
#include "learning/tone_fit.hpp"
#include "model/model_header.hpp"
#include "recordings/prepared_recording.hpp"

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace haptoflow::learning {

struct LearntSeed {
    std::array<double, 2> velocityMps{};
    double forceNewtons = 0.0;
    /// With an RMS of 1 and without the tone, which restores the recording's spectrum.
    std::array<float, model::seedSamples> samples{};
    /// Phase along each wave vector in cycles at sample 200, in the network's convention; empty without ribs.
    std::optional<std::array<double, inference::ribCount>> ribPhase{};
    /// Sample of the recording at which it starts.
    std::size_t start = 0;
};

inline constexpr std::size_t maximumLearntSeeds = 8;

/// Chooses stretches of the recording with speeds, forces and directions as different as possible.
[[nodiscard]] std::vector<LearntSeed> chooseSeeds(const recordings::PreparedRecording& recording,
                                                  const Sliding& sliding, std::span<const float> unitWave,
                                                  const model::ToneTable& tone);

}  // namespace haptoflow::learning
