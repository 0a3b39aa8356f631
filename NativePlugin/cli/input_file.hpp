#pragma once

#include <stdexcept>
#include <string>

namespace haptoflow::cli {

/// An input file is wrong. The message names the file, the line or key, and the expected content.
class InputError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// Reads a whole file or pipe, up to 1 GiB. `expected` names the kind of file for errors. Throws InputError that names
/// the path if the file is missing, a folder, unreadable or too large.
[[nodiscard]] std::string readInputFile(const std::string& path, const std::string& expected);

}  // namespace haptoflow::cli
