#pragma once

#include <cstdint>
#include <span>

namespace haptoflow::skeleton {

/// Key of one block of noise. Equal keys give equal noise; different keys give independent noise.
struct NoiseKey {
    std::uint64_t seed = 0;
    std::uint32_t voice = 0;
    std::uint64_t segment = 0;
};

/// Fills `noise` with standard normal numbers that depend only on `key` and the position, so that the noise of a
/// segment can be generated without that of the segments before it. The bytes are the same on every platform, because
/// it uses Philox-4x32-10 (Salmon et al., "Parallel random numbers: as easy as 1, 2, 3", 2011) and a Box-Muller
/// transform with only correctly rounded IEEE 754 operations. Any thread; no allocation. A key has 2^33 numbers, which
/// then begin again.
///
/// `first`: the position of the first number, so that a long noise can be read piece by piece.
void fillStandardNormal(const NoiseKey& key, std::span<float> noise, std::uint64_t first = 0) noexcept;

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

}  // namespace haptoflow::skeleton
