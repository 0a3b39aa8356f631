#pragma once

#include "headless/scenes/input_file.hpp"

#include <stdexcept>
#include <string>

namespace haptoflow::cli {

inline constexpr int exitDone = 0;
inline constexpr int exitUsage = 2;
inline constexpr int exitBadInput = 3;
inline constexpr int exitInternal = 4;

/// The options contradict each other in a way that CLI11 cannot check.
class UsageError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

}  // namespace haptoflow::cli
