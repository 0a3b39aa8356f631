#pragma once

#include "learning/closed_loop.hpp"
#include "learning/learning_report.hpp"
#include "learning/learning_settings.hpp"
#include "learning/level_law.hpp"
#include "learning/tone_fit.hpp"
#include "model/model_file.hpp"

#include <optional>
#include <string>

namespace haptoflow::learning {

/// The content of a material file.
struct MaterialContent {
    const LearningSettings& settings;
    const LearningReport& report;
    /// The label at which the search began: source of the properties that the recording does not show.
    const model::Label& start;
    const Embedding& embedding;
    const LevelLaw& level;
    const model::ToneTable& tone;
    float impulseGain = 1.0F;
    double frequencyExponent = 0.0;
    std::optional<double> wavelengthMetres;
};

/// The text of a `.haptomaterial` file, ending in a line feed.
[[nodiscard]] std::string materialText(const model::ModelFile& model, const MaterialContent& content);

}  // namespace haptoflow::learning
