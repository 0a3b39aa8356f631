#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace haptoflow::inference {

/// A sample's way at 0.2 mm/s, and at 100 m/s.
inline constexpr double shortestStepMetres = 1e-7;
inline constexpr double longestStepMetres = 0.05;

/// A straight path over a surface, in the surface's own frame. Coordinates up to 10^6 m.
struct SurfacePath {
    std::array<double, 3> startMetres{};
    /// Way of one sample.
    std::array<double, 3> stepMetres{};
};

/// Fills `noise` with standard normal numbers that belong to the surface: a white field, fixed to the surface, as a
/// path over it meets it in time, limited to 750 Hz and falling to nothing at 1250 Hz. The same place therefore has the
/// same wave, wherever on it the samples fall, in both directions and, as far as the bands overlap, at every speed;
/// along any path at any speed from 1 mm/s to 20 m/s the numbers are uncorrelated. Different values of `surface` give
/// independent fields.
///
/// The field is a sum of 12 Brownian motions B_k, each along one direction u_k through the surface's frame. With
/// q_k = position . u_k, the increment of B_k over each cell of q_k that the path passes, taken from the smaller q_k to
/// the larger, is an impulse at the time at which the middle of the cell is passed:
/// z[n] = sum_k sum_cells h(n + 1/2 - t_cell) dB_k / sqrt(sum_k |dq_k|), h being the filter of surface_noise_kernel.hpp
/// and dq_k the way of a sample along u_k. B_k is refined by halving (Levy's construction: Karatzas and Shreve,
/// "Brownian motion and stochastic calculus", 2.3) from hashed numbers, down to cells no longer than a sample's way, so
/// nothing is stored and the cost is the same at every speed. Only correctly rounded operations are used, so every
/// platform gets the same bytes.
///
/// Returns false, and leaves `noise` unchanged, if a sample's way is shorter or longer than that, or a coordinate is
/// not finite or beyond 10^6 m. Any thread; no allocation.
[[nodiscard]] bool fillSurfaceNoise(std::uint64_t surface, const SurfacePath& path, std::span<float> noise) noexcept;

}  // namespace haptoflow::inference
