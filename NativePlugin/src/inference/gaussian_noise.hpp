#pragma once

#include <cstdint>
#include <span>

namespace haptoflow::inference {

/// Names one block of noise. Equal keys give equal noise; different keys give independent noise.
struct NoiseKey {
    std::uint64_t seed = 0;
    std::uint32_t voice = 0;
    std::uint64_t segment = 0;
};

/// Fills `noise` with standard normal numbers that depend on `key` and the position alone, so that any segment's
/// noise can be made again without making those before it. The bytes are the same on every platform: Philox-4x32-10
/// (Salmon et al., "Parallel random numbers: as easy as 1, 2, 3", 2011) and a Box-Muller transform that uses only
/// operations which IEEE 754 rounds correctly. Any thread; no allocation. At most 2^33 numbers.
void fillStandardNormal(const NoiseKey& key, std::span<float> noise) noexcept;

}  // namespace haptoflow::inference
