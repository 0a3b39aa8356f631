#pragma once

#include "learning/learning_report.hpp"

#include <string>

namespace haptoflow::cli {

/// An SVG picture of recording, material and nearest label beside each other: a spectrum for each range of speed, the
/// level over speed for each range of force, kurtosis and ribs over speed. Dashed is what no recording supports.
[[nodiscard]] std::string learningPicture(const learning::LearningReport& report, const std::string& name);

}  // namespace haptoflow::cli
