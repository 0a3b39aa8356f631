#pragma once

#include <cstddef>

namespace haptoflow::testing {

/// Number of calls of operator new in this program. Linking counting_new.cpp replaces that operator, on every platform.
/// It counts C++ allocations only; Tests/Native/realtime also counts heap calls of C libraries.
[[nodiscard]] std::size_t allocationCount() noexcept;

}  // namespace haptoflow::testing
