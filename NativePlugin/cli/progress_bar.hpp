#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace haptoflow::cli {

/// Receives the completed share, 0 to 1, and the name of the present step, which may be empty.
using ProgressBar = std::function<void(double, std::string_view)>;

/// A bar on standard error that begins with the command's name; if standard error is not a terminal, a line every ten
/// seconds; nothing if `quiet`.
[[nodiscard]] ProgressBar progressBar(std::string_view command, bool quiet);

/// Prints a line, "render: 42 %", every ten seconds of a clock in seconds.
[[nodiscard]] ProgressBar progressLines(std::string_view command, std::function<double()> clockSeconds,
                                        std::function<void(const std::string&)> say);

}  // namespace haptoflow::cli
