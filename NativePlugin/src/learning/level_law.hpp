#pragma once

#include "learning/prepared_recording.hpp"
#include "learning/sliding.hpp"

#include <vector>

namespace haptoflow::learning {

/// How strong the material vibrates: a table of log RMS over log speed and a power of the force.
struct LevelLaw {
    /// 1 to 16, rising; where one speed alone was recorded, one.
    std::vector<double> speedsMps;
    /// Natural logarithm of the RMS in m/s^2 at `forceNewtons`.
    std::vector<double> logLevels;
    double forceNewtons = 1.0;
    double forceExponent = 0.0;
    /// Beyond the table's ends.
    double speedExponent = 0.0;

    /// Straight lines in log(v + 0.0005 m/s) between the table's speeds; the force floored at 0.02 N.
    [[nodiscard]] double logLevel(double speedMps, double force) const;
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
