#pragma once

#include <cstdint>

namespace haptoflow::inference {

/// The finalizer of SplitMix64 (Steele, Lea and Flood 2014): every bit of the result depends on every bit of the value.
[[nodiscard]] constexpr std::uint64_t mixed(std::uint64_t value) noexcept {
    value = (value ^ (value >> 30U)) * 0xBF58476D1CE4E5B9U;
    value = (value ^ (value >> 27U)) * 0x94D049BB133111EBU;
    return value ^ (value >> 31U);
}

/// A number in [0, 1) for each index of a key: a hash without period.
[[nodiscard]] constexpr double fractionOf(std::uint64_t key, std::uint64_t index) noexcept {
    constexpr std::uint64_t step = 0x9E3779B97F4A7C15U;
    return static_cast<double>(mixed(mixed(key) + step * (index + 1U)) >> 11U) * 0x1p-53;
}

}  // namespace haptoflow::inference
