#pragma once

#include "inference/segment_generator.hpp"
#include "learning/closed_loop.hpp"
#include "learning/level_law.hpp"
#include "learning/sliding.hpp"
#include "model/model_file.hpp"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace haptoflow::learning {

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
