#pragma once

#include "learning/prepared_recording.hpp"
#include "learning/sliding.hpp"
#include "model/material_tables.hpp"

namespace haptoflow::learning {

/// How strong the material vibrates.
struct LevelLaw {
    /// Where one speed alone was recorded, it holds one.
    model::LevelTable table;
    /// Beyond the table's ends.
    double speedExponent = 0.0;

    [[nodiscard]] double logLevel(double speedMps, double newtons) const noexcept {
        return table.logLevel(speedMps, newtons, speedExponent);
    }
};

/// What other materials have: the mean of their exponents and how far they are from it.
struct ExponentPrior {
    double speedMean = 0.9;
    double speedSpread = 0.2;
    double forceMean = 0.25;
    double forceSpread = 0.18;
};

/// Fits the law to the power of frames of 50 ms, each as likely as its chi-squared distribution has it: between knots
/// the slope may leave a common one as far as the frames insist. Few speeds leave the exponents to the prior.
[[nodiscard]] LevelLaw fitLevelLaw(const PreparedRecording& recording, const Sliding& sliding,
                                   const ExponentPrior& prior);

}  // namespace haptoflow::learning
