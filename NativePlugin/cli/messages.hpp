#pragma once

#include <string_view>

namespace haptoflow::cli {

/// Prints "haptoflow: " and the text to standard error. Control characters, which may come from a file, are escaped.
void complain(std::string_view text);
/// As `complain`, for a remark on a command that goes on: "haptoflow: note: ".
void note(std::string_view text);

}  // namespace haptoflow::cli
