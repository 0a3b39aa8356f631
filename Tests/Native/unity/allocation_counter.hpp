#pragma once

#include <cstddef>

namespace haptoflow::unity::testing {

/// Counts the calling thread's heap calls during its lifetime, in this program and in all loaded libraries. Only one
/// instance per thread.
class AllocationCounter {
public:
    AllocationCounter();
    AllocationCounter(const AllocationCounter&) = delete;
    AllocationCounter& operator=(const AllocationCounter&) = delete;
    ~AllocationCounter();

    /// Number of allocations, reallocations and frees.
    [[nodiscard]] std::size_t calls() const;
};

}  // namespace haptoflow::unity::testing
