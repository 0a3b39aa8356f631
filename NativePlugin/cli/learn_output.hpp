#pragma once

#include "learning/learning_report.hpp"

#include <string>
#include <string_view>

namespace haptoflow::cli {

/// An SVG picture that compares the recording, the learnt material and the nearest label: a spectrum for each range of
/// speed; the level over speed for each range of force, dashed where nothing was recorded; kurtosis and ribs over
/// speed.
[[nodiscard]] std::string learningPicture(const learning::LearningReport& report, const std::string& name);

/// A file name, without folder and extension, from words that may hold anything: "../a/b" gives "a-b". Never empty,
/// never hidden, no separator of any platform.
[[nodiscard]] std::string fileNameOf(std::string_view words);

}  // namespace haptoflow::cli
