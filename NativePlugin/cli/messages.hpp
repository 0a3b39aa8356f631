#pragma once

#include <iosfwd>
#include <string>
#include <string_view>

namespace haptoflow::headless {
struct Scene;
}

namespace haptoflow::cli {

struct Stroke;

/// Prints "haptoflow: " and the text to standard error. Control characters, which may come from a file, are escaped.
void complain(std::string_view text);
/// As `complain`, for a remark on a command that goes on: "haptoflow: note: ".
void note(std::string_view text);
/// A note for each moving surface whose keyframes go on long after the stroke: they may be in milliseconds.
void noteLateKeyframes(const headless::Scene& scene, const Stroke& stroke, const std::string& sceneName);
/// Where a command prints its figures: standard output, or standard error while an output of it is standard output.
[[nodiscard]] std::ostream& resultStream();

}  // namespace haptoflow::cli
