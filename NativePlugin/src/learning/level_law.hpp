#pragma once

#include "inference/segment_generator.hpp"
#include "learning/closed_loop.hpp"
#include "learning/sliding.hpp"
#include "model/material_tables.hpp"
#include "model/model_file.hpp"
#include "recordings/prepared_recording.hpp"

#include <optional>
#include <span>
#include <string>
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

/// An embedding and a motion along the first axis.
struct LevelCondition {
    Embedding embedding{};
    double speedMps = 0.0;
    double forceNewtons = 0.0;
};

/// The level (RMS in m/s^2) that the model gives each condition.
[[nodiscard]] std::vector<float> levelsOf(inference::SegmentGenerator& generator,
                                          std::span<const LevelCondition> conditions);

/// Throws std::invalid_argument if the model gives all its labels one level at every motion: that is the unit of its
/// networks, which carry the labels' levels themselves, and a material's own level in its place would be taken for the
/// unit.
void requireOwnLevels(const model::ModelFile& model, inference::SegmentGenerator& generator);

/// Mean and standard deviation of the labels' exponents; the defaults if the model has fewer than three labels.
[[nodiscard]] ExponentPrior exponentPrior(const model::ModelHeader& model);

/// Compares the level at the recording's median speed and force with those of the model's labels, because a unit that
/// is wrong by a factor of ten or a thousand shows only there. Returns a warning, or nothing if the level is plausible.
/// Throws recordings::RecordingUnusable if no material can have it.
[[nodiscard]] std::optional<std::string> levelWarning(const LevelLaw& level, const Sliding& sliding,
                                                      const model::ModelFile& model,
                                                      inference::SegmentGenerator& generator);

}  // namespace haptoflow::learning
