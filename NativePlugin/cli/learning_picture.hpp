#pragma once

#include "learning/learning_report.hpp"

#include <string>

namespace haptoflow::cli {

/// An SVG picture that compares the recording, the learnt material and the nearest label: a spectrum for each range of
/// speed; the level over speed for each range of force, dashed where nothing was recorded; kurtosis and ribs over
/// speed.
[[nodiscard]] std::string learningPicture(const learning::LearningReport& report, const std::string& name);

}  // namespace haptoflow::cli
