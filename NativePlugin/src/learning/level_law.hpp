#pragma once

#include "learning/sliding.hpp"
#include "model/material_tables.hpp"
#include "recordings/prepared_recording.hpp"

#include <array>
#include <span>
#include <vector>

namespace haptoflow::learning {

/// The level of a material as a function of speed and force.
struct LevelLaw {
    /// Has a single speed if only one was recorded.
    model::LevelTable table;
    /// Exponent beyond the table's ends.
    double speedExponent = 0.0;

    [[nodiscard]] double logLevel(double speedMps, double newtons) const noexcept {
        return table.logLevel(speedMps, newtons, speedExponent);
    }
};

/// Exponents of other materials: mean and standard deviation.
struct ExponentPrior {
    double speedMean = 0.9;
    double speedSpread = 0.2;
    double forceMean = 0.25;
    double forceSpread = 0.18;
};

/// A tenth of a second of sliding.
struct LevelFrame {
    /// Logarithms of the mean speed plus LevelTable::restMps, in m/s, and of the mean force in N.
    double logSpeed = 0.0;
    double logForce = 0.0;
    /// Mean square in m^2/s^4.
    double power = 0.0;
};

inline constexpr std::size_t levelFrameSamples = 200;

/// The frame of one wave in m/s^2 and the motion (vx, vy, force) of its samples.
[[nodiscard]] LevelFrame levelFrame(std::span<const float> wave, std::span<const std::array<float, 3>> motion);

/// Fits the law to the power of frames that overlap by half, by maximum likelihood with a Gamma distribution, which
/// matches the recorded power even where single impacts make its logarithms uneven. The level is a curve over log
/// speed; its slope and the exponent of the force are drawn towards the prior. Needs one frame.
[[nodiscard]] LevelLaw fitLevelLaw(std::span<const LevelFrame> frames, const ExponentPrior& prior);

/// The same for a recording's steady frames. Throws recordings::RecordingUnusable if it hardly has any.
[[nodiscard]] LevelLaw fitLevelLaw(const recordings::PreparedRecording& recording, const Sliding& sliding,
                                   const ExponentPrior& prior);

}  // namespace haptoflow::learning
