#pragma once

#include "inference/surface_noise.hpp"

#include <cstdint>

namespace haptoflow::engine {

/// A smooth random field at one point of a path: its value, and its change over the way of one sample.
struct WanderPoint {
    double value = 0.0;
    double changePerSample = 0.0;
};

/// A smooth random field of RMS 1 over a surface, where `path` begins. The same place has the same value; fields of
/// different keys are independent. It is a sum of twelve plane waves in random directions whose lengths lie within half
/// an octave of `wavelengthMetres`, which must be above 0. Any thread; no allocation.
[[nodiscard]] WanderPoint surfaceWander(std::uint64_t key, double wavelengthMetres,
                                        const inference::SurfacePath& path) noexcept;

}  // namespace haptoflow::engine
