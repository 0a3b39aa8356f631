#pragma once

#include <stdexcept>
#include <string>

namespace haptoflow::cli {

inline constexpr int exitDone = 0;
inline constexpr int exitUsage = 2;
inline constexpr int exitBadInput = 3;
inline constexpr int exitInternal = 4;

/// A file that the user gave is wrong. The message names the file, the line or key, and what was expected.
class InputError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// The words of the command line contradict each other in a way CLI11 cannot see.
class UsageError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

}  // namespace haptoflow::cli
