#pragma once

#include <functional>
#include <string_view>

namespace haptoflow::cli {

/// Takes the share that is done, 0 to 1, and a word for what is being done, which may be empty.
using ProgressBar = std::function<void(double, std::string_view)>;

/// A bar on standard error that begins with the command's name; one that shows nothing where `quiet` or where standard
/// error is no terminal.
[[nodiscard]] ProgressBar progressBar(std::string_view command, bool quiet);

}  // namespace haptoflow::cli
