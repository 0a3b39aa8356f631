#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace haptoflow::engine {

/// Percentiles of a stream of values in a fixed 2 MiB, however many there are: values that differ by less than 0.1 %
/// may share a bin. Not for the audio thread: making one allocates.
class ValueHistogram {
public:
    ValueHistogram();

    /// Negative values and values that are not numbers count as 0.
    void add(float value) noexcept;
    [[nodiscard]] std::uint64_t count() const noexcept { return count_; }
    /// The value at rank `share` x (count - 1), rounded down, share from 0 to 1; 0 where there is none. What was put in
    /// is at least this and at most 0.1 % more.
    [[nodiscard]] float valueAtShare(double share) const noexcept;
    /// How many values lie in bins above that of `value`.
    [[nodiscard]] std::uint64_t countAbove(float value) const noexcept;

private:
    std::vector<std::uint64_t> bins_;
    std::uint64_t count_ = 0;
};

}  // namespace haptoflow::engine
