#pragma once

#include <cstddef>

namespace haptoflow::unity::testing {

/// Counts what this thread asks of the heap while it lives, in this program and in every library it has loaded. One at
/// a time on a thread.
class AllocationCounter {
public:
    AllocationCounter();
    AllocationCounter(const AllocationCounter&) = delete;
    AllocationCounter& operator=(const AllocationCounter&) = delete;
    ~AllocationCounter();

    /// Memory asked for, changed or given back, so many times.
    [[nodiscard]] std::size_t calls() const;
};

}  // namespace haptoflow::unity::testing
