#pragma once

#include "learning/sliding.hpp"
#include "model/material_tables.hpp"
#include "recordings/prepared_recording.hpp"

#include <string>

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

/// Fits the law to the power of frames of 50 ms by maximum likelihood, with chi-squared distributed power. The slope
/// between knots may differ from the common one where the frames require it. With few speeds the exponents come from
/// the prior.
[[nodiscard]] LevelLaw fitLevelLaw(const recordings::PreparedRecording& recording, const Sliding& sliding,
                                   const ExponentPrior& prior);

/// One sentence: what to record next so that the material gains most. Empty if nothing much is missing.
///
/// Compared are the ends of what hands do (20 to 300 mm/s, 0.3 to 2 N) that the recording lacks: how uncertain the
/// level is there, from how much labels differ in the exponents that take the recording's place.
[[nodiscard]] std::string recordNext(const Sliding& sliding, const ExponentPrior& prior);

}  // namespace haptoflow::learning
