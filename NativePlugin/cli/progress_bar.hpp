#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace haptoflow::cli {

/// Takes the share that is done, 0 to 1, and a word for what is being done, which may be empty.
using ProgressBar = std::function<void(double, std::string_view)>;

/// A bar on standard error that begins with the command's name; where standard error is no terminal, a line each ten
/// seconds; nothing where `quiet`.
[[nodiscard]] ProgressBar progressBar(std::string_view command, bool quiet);

/// Says a line, "render: 42 %", each time ten seconds have gone by on a clock in seconds.
[[nodiscard]] ProgressBar progressLines(std::string_view command, std::function<double()> clockSeconds,
                                        std::function<void(const std::string&)> say);

}  // namespace haptoflow::cli
