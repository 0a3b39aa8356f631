#pragma once

#include "model/model_header.hpp"

#include <array>
#include <span>

namespace haptoflow::engine {

/// A recorded waveform that is played at touch-down, with the motion at which it was recorded.
struct Seed {
    std::array<double, 2> velocityMps{};
    double forceNewtons = 0.0;
    std::array<double, 2> ribPhase{};
    /// RMS of the played seed relative to the level.
    float gain = 1.0F;
    std::span<const float, model::seedSamples> samples;
    /// Embedding of the recorded material; the rib phase refers to its wave vectors.
    std::span<const float, model::embeddingSize> embedding;
};

/// The seed recorded at the motion nearest to `motion`, compared by the logarithms of speed and force and by the
/// direction of the line of motion (forwards and backwards are equal). Null if there is none. Source: HaptoFlow,
/// section 4.1 (first previous waveform retrieved from the training recordings).
[[nodiscard]] const Seed* retrieveSeed(std::span<const Seed> seeds, const std::array<float, 3>& motion) noexcept;

}  // namespace haptoflow::engine
