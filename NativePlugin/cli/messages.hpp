#pragma once

#include "headless/command_files.hpp"

#include <functional>
#include <iosfwd>
#include <string>
#include <string_view>

namespace haptoflow::headless {
struct Scene;
struct Stroke;
}  // namespace haptoflow::headless

namespace haptoflow::cli {

/// Exit codes of the program.
inline constexpr int exitDone = 0;
inline constexpr int exitUsage = 2;
inline constexpr int exitBadInput = 3;
inline constexpr int exitInternal = 4;

using headless::InputError;
using headless::UsageError;

/// The number with a fixed count of digits after the decimal point, in every locale; never "-0".
[[nodiscard]] std::string fixedDecimals(double value, int digits);

/// A length or a speed in metres as whole millimetres, without the unit.
[[nodiscard]] std::string inMillimetres(double metres);

/// Receives the completed share, 0 to 1, and the name of the present step, which may be empty.
using ProgressBar = std::function<void(double, std::string_view)>;

/// A bar on standard error that begins with the command's name; if standard error is not a terminal, a line every ten
/// seconds; nothing if `quiet`.
[[nodiscard]] ProgressBar progressBar(std::string_view command, bool quiet);

/// Prints a line, "render: 42 %", every ten seconds of a clock in seconds.
[[nodiscard]] ProgressBar progressLines(std::string_view command, const std::function<double()>& clockSeconds,
                                        std::function<void(const std::string&)> say);

/// Prints "haptoflow: " and the text to standard error. Control characters, which may come from a file, are escaped.
void complain(std::string_view text);
/// As `complain`, for a remark on a command that goes on: "haptoflow: note: ".
void note(std::string_view text);
/// A note for each moving surface whose keyframes go on long after the stroke: they may be in milliseconds.
void noteLateKeyframes(const headless::Scene& scene, const headless::Stroke& stroke, const std::string& sceneName);
/// Where a command prints its figures: standard output, or standard error while an output of it is standard output.
[[nodiscard]] std::ostream& resultStream();

}  // namespace haptoflow::cli
