#pragma once

#include <cstddef>

namespace haptoflow::testing {

/// How often operator new was called in this program so far. Linking counting_new.cpp replaces that operator; it does
/// so on every platform, and sees C++ only: heap calls of C libraries are watched in Tests/Native/realtime and unity.
[[nodiscard]] std::size_t allocationCount() noexcept;

}  // namespace haptoflow::testing
