#pragma once

#include <stdexcept>
#include <string>

namespace haptoflow::cli {

/// An input file is wrong. The message names the file, the line or key, and the expected content.
class InputError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// Reads a whole file or pipe, up to 1 GiB. `role` is the file's part in the command, "the scene", `expected` its kind,
/// for errors. Throws InputError that names the path if the file is missing, a folder, unreadable or too large, and
/// UsageError if it is an output (command_files.hpp).
[[nodiscard]] std::string readInputFile(const std::string& role, const std::string& path, const std::string& expected);

}  // namespace haptoflow::cli
