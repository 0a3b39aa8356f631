#pragma once

#include "skeleton/gaussian_noise.hpp"
#include "skeleton/skeleton_layout.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace haptoflow::skeleton {

/// Slots of time into which the cells that a path passes are sorted.
inline constexpr std::size_t noiseSlotsPerSample = 8;
/// The filter's length on either side of a sample's middle.
inline constexpr std::size_t noiseReachSamples = 8;

/// Second half of the filter, which is symmetric: the root of a raised cosine with a roll-off of 0.25 (Proakis,
/// "Digital communications", 9.2), in the middles of the slots, with a mean square of 1 / 16. It lets all pass below
/// 750 Hz and nothing beyond 1250 Hz, and filtered white noise is white again at whole samples. A table, because sines
/// differ from one platform's library to the next.
inline constexpr std::array<float, noiseReachSamples * noiseSlotsPerSample> noiseKernelHalf{
    1.06023896F,     0.996766269F,    0.87694478F,     0.714038253F,    0.52563411F,     0.33127442F,
    0.149892911F,    -0.00256012613F, -0.114963688F,   -0.182094485F,   -0.204799786F,   -0.189300939F,
    -0.145787776F,   -0.0865658F,     -0.0240717623F,  0.0309271943F,   0.0706880242F,   0.0912293792F,
    0.0923959985F,   0.0773085952F,   0.0513546616F,   0.020937629F,    -0.00777820637F, -0.0299127977F,
    -0.0425495766F,  -0.0449735112F,  -0.038479127F,   -0.0258357804F,  -0.0105503118F,  0.00391081721F,
    0.0147882728F,   0.0204716232F,   0.0206578802F,   0.0162297338F,   0.00891078543F,  0.000792939099F,
    -0.00615375163F, -0.0104865888F,  -0.0115368748F,  -0.00946364645F, -0.00512377266F, 0.000195032349F,
    0.00510749454F,  0.00845233444F,  0.00953378342F,  0.00823802408F,  0.00501031894F,  0.000709815475F,
    -0.00361593137F, -0.00698071998F, -0.0086768819F,  -0.00841455068F, -0.00635812012F, -0.00305937254F,
    0.000690610381F, 0.00405234145F,  0.00632654363F,  0.00709899189F,  0.00631255843F,  0.00425543496F,
    0.00147372636F,  -0.00136720308F, -0.00363851921F, -0.00488511613F,
};

inline constexpr std::array<float, 2 * noiseKernelHalf.size()> noiseKernel = [] {
    std::array<float, 2 * noiseKernelHalf.size()> both{};
    for (std::size_t index = 0; index < noiseKernelHalf.size(); ++index) {
        both[noiseKernelHalf.size() + index] = noiseKernelHalf[index];
        both[noiseKernelHalf.size() - 1 - index] = noiseKernelHalf[index];
    }
    return both;
}();

/// A sample's way at 0.2 mm/s, and at 100 m/s.
inline constexpr double shortestStepMetres = 1e-7;
inline constexpr double longestStepMetres = 0.05;

/// A straight path over a surface, in the surface's own frame. Coordinates up to 10^6 m.
struct SurfacePath {
    std::array<double, 3> startMetres{};
    /// Way of one sample.
    std::array<double, 3> stepMetres{};
};

/// One of the surface's Brownian motions, refined where a path reads it. A plain value.
class BrownianMotion {
public:
    static constexpr std::size_t cellsPerBlock = 8;
    static constexpr std::size_t levelCount = 7;
    /// Before each cell of a block, and after the last.
    using Sums = std::array<double, cellsPerBlock + 1>;

    BrownianMotion() = default;
    explicit BrownianMotion(std::uint64_t key) noexcept : key_(key) {}

    [[nodiscard]] std::uint64_t key() const noexcept { return key_; }
    /// Sums of the increments of a block's cells, known at multiples of `stride` (1, 2 or 4) cells.
    [[nodiscard]] const Sums& sumsOf(std::size_t level, std::int64_t block, std::size_t stride) noexcept;

private:
    struct Block {
        std::int64_t index = 0;
        /// Distance of the known sums; longer than any before the first use.
        std::size_t stride = cellsPerBlock;
        Sums sums{};
    };

    void fill(Block& block, std::size_t level) noexcept;
    [[nodiscard]] double parentIncrement(std::size_t level, std::int64_t cell) noexcept;

    std::uint64_t key_ = 0;
    std::array<Block, levelCount> blocks_{};
};

/// Standard normal numbers that belong to the surface: a white field, fixed to the surface, as a path over it meets it
/// in time, limited to 750 Hz and falling to nothing at 1250 Hz. The same place therefore has the same wave, wherever
/// on it the samples fall, in both directions and, as far as the bands overlap, at every speed; along any path at any
/// speed from 1 mm/s to 20 m/s the numbers are uncorrelated. Different values of `surface` give independent fields.
///
/// The field is a sum of 12 Brownian motions B_k, each along one direction u_k through the surface's frame. With
/// q_k = position . u_k, the increment of B_k over each cell of q_k that the path passes, taken from the smaller q_k to
/// the larger, is an impulse at the time at which the middle of the cell is passed:
/// z[n] = sum_k sum_cells h(n + 1/2 - t_cell) dB_k / sqrt(sum_k |dq_k|), h being the filter noiseKernel
/// and dq_k the way of a sample along u_k. B_k is refined by halving (Levy's construction: Karatzas and Shreve,
/// "Brownian motion and stochastic calculus", 2.3) from hashed numbers, down to cells no longer than a sample's way, so
/// nothing is stored for good and the cost is the same at every speed. Only correctly rounded operations are used, so
/// every platform gets the same bytes.
///
/// The filter reaches 7.5 samples ahead: cells are read that long before the tip is there, on the way that it then has.
/// When the path changes, the new one does not begin where the cells were last read. Reading goes on from there and
/// comes to the new path within 8 samples, so that no cell is read twice or left out. If the two places are more than 4
/// samples' way apart (the tip turned back or jumped), reading begins at once on the new path.
///
/// A plain value: a copy goes on as the original does. Allocates nothing.
class SurfaceNoise {
public:
    /// Writes at most `pieceSamples` numbers along a path, whose start is the place of the first. Where a sample's way
    /// is shorter or longer than the limits above, or a coordinate is not finite or beyond 10^6 m, they are those of
    /// `otherwise`.
    void next(std::uint64_t surface, const SurfacePath& path, const NoiseKey& otherwise,
              std::span<float> noise) noexcept;
    /// Call it when the path given to `next` changes.
    void follow() noexcept { isNewPath_ = true; }
    /// Goes on by that many numbers that nobody needs.
    void skip(std::size_t samples) noexcept;

private:
    static constexpr std::size_t directionCount = 12;
    /// What the filter still needs of the samples before.
    static constexpr std::size_t memorySamples = 2 * noiseReachSamples - 1;
    static constexpr std::size_t memorySlots = memorySamples * noiseSlotsPerSample;

    using Vector = std::array<double, 3>;

    /// Adds to the slots the cells that lie between the last place read and `to`.
    void readCells(std::uint64_t surface, const Vector& to, std::span<float> slots) noexcept;
    /// Reads the cells along a path, ahead of it, from the first slot of which nothing is known.
    void readAlong(std::uint64_t surface, const SurfacePath& path, std::span<float> slots) noexcept;

    std::array<BrownianMotion, directionCount> motions_{};
    /// The increments of the cells, summed in slots of the time at which the path passes their middles.
    std::array<float, memorySlots + pieceSamples * noiseSlotsPerSample> passage_{};
    Vector readMetres_{};
    /// From the path to the last place read, and the number of samples in which reading will have come to the path.
    Vector lagMetres_{};
    std::size_t lagSamples_ = 0;
    bool isNewPath_ = false;
    std::uint64_t numbers_ = 0;
    /// The memory holds the cells before the next sample.
    bool isPrimed_ = false;
};

}  // namespace haptoflow::skeleton
