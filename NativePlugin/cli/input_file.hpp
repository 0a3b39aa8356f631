#pragma once

#include <string>

namespace haptoflow::cli {

/// Everything in a file or pipe, up to 1 GiB. `expected` says what kind of file belongs there. Throws InputError that
/// names the path: not there, a folder, not readable to its end, too large.
[[nodiscard]] std::string readInputFile(const std::string& path, const std::string& expected);

}  // namespace haptoflow::cli
