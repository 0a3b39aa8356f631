#pragma once

#include "model/model_header.hpp"

#include <array>
#include <span>

namespace haptoflow::engine {

/// A recorded waveform from which a touch may begin.
struct Seed {
    std::array<double, 2> velocityMps{};
    double forceNewtons = 0.0;
    std::array<double, 2> ribPhase{};
    std::span<const float, model::seedSamples> samples;
    /// Of the material that it was recorded from: its wave vectors are what the rib phase counts along.
    std::span<const float, model::embeddingSize> embedding;
};

/// The seed whose conditions are nearest to the motion: in the logarithms of speed and force, and in direction along
/// the line of motion. Null where there is none. Source: HaptoFlow, section 4.1 (first previous waveform retrieved from
/// the training recordings).
[[nodiscard]] const Seed* retrieveSeed(std::span<const Seed> seeds, const std::array<float, 3>& motion) noexcept;

}  // namespace haptoflow::engine
