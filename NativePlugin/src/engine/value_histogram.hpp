#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace haptoflow::engine {

/// Percentiles of a stream of values in a fixed 2 MiB. Values that differ by less than 0.1 % may share a bin.
/// Construction allocates: not on the audio thread.
class ValueHistogram {
public:
    ValueHistogram();

    /// Negative values and NaN count as 0.
    void add(float value) noexcept;
    [[nodiscard]] std::uint64_t count() const noexcept { return count_; }
    /// The value at rank `share` * (count - 1), rounded down, with `share` from 0 to 1; 0 if the histogram is empty.
    /// The result is the lower end of the bin, at most 0.1 % below the actual value.
    [[nodiscard]] float valueAtShare(double share) const noexcept;
    /// Number of values in bins above that of `value`.
    [[nodiscard]] std::uint64_t countAbove(float value) const noexcept;

private:
    std::vector<std::uint64_t> bins_;
    std::uint64_t count_ = 0;
};

}  // namespace haptoflow::engine
