#include "inference/surface_noise.hpp"

#include "inference/gaussian_noise.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace haptoflow::inference {
namespace {

using Vector = std::array<double, 3>;

constexpr std::size_t directionCount = 12;
constexpr std::size_t cellsPerBlock = 8;
constexpr int logCellsPerBlock = 3;
// A longer coordinate would leave the integers that a double holds exactly.
constexpr double maximumMetres = 1e6;
// Across its direction, each Brownian motion changes sign at random from one sheet to the next. Without that, a path
// beside another would meet a twelfth of the other's noise again, at a distance.
constexpr double sheetMetres = 0.001;

/// Equal areas of a half sphere, turned so that they lie evenly in each coordinate plane, where most surfaces are.
constexpr std::array<Vector, directionCount> directions{{
    {0.76273, 0.17233, -0.62333},
    {-0.22771, -0.67898, 0.69795},
    {-0.54054, 0.50524, -0.67272},
    {0.79248, -0.59208, -0.14633},
    {-0.90720, -0.35173, 0.23081},
    {0.18111, 0.13196, -0.97457},
    {0.12899, -0.97063, 0.20307},
    {-0.84877, -0.07266, -0.52374},
    {0.44460, -0.53928, -0.71520},
    {-0.53675, -0.84291, -0.03754},
    {-0.34051, -0.30665, -0.88883},
    {-0.05871, -0.85807, -0.51016},
}};

/// Rounded down. `divisor` is a power of two.
constexpr std::int64_t floorDivided(std::int64_t value, std::int64_t divisor) noexcept {
    const std::int64_t rest = value & (divisor - 1);
    return (value - rest) / divisor;
}

/// Cells of one size. Each is divided into the eight cells of a block of the next level.
struct Level {
    double cellMetres = 0.0;
    /// Deviation of a cell's increment.
    double deviation = 0.0;
};

// From 7.8 mm to 30 nm, a twentieth of a sample's way at 1 mm/s. 0.3535534 is the root of an eighth.
constexpr double rootOfEighth = 0.35355339059327379;
constexpr std::array<Level, 7> levels{{
    {0x1p-7, 0x1p-3 * 2.0 * rootOfEighth},
    {0x1p-10, 0x1p-5},
    {0x1p-13, 0x1p-5 * rootOfEighth},
    {0x1p-16, 0x1p-8},
    {0x1p-19, 0x1p-8 * rootOfEighth},
    {0x1p-22, 0x1p-11},
    {0x1p-25, 0x1p-11 * rootOfEighth},
}};

double dot(const Vector& a, const Vector& b) noexcept {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// A direction across direction `k`.
Vector across(std::size_t k) noexcept {
    const Vector& a = directions[k];
    const Vector& b = directions[(k + 5) % directionCount];
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// The cells that a path is divided into along one direction: the coarsest of a level, of its pairs or of its fours
/// that are no longer than a sample's way. They are longer than half of it, except at the deepest level.
struct Grid {
    std::size_t level = 0;
    /// 1, 2 or 4 of the level's cells.
    std::size_t stride = 4;

    explicit Grid(double wayMetres) noexcept {
        while (levels[level].cellMetres > wayMetres && level + 1 < levels.size()) {
            ++level;
        }
        while (static_cast<double>(stride) * levels[level].cellMetres > wayMetres && stride > 1) {
            stride /= 2;
        }
    }
    [[nodiscard]] double cellMetres() const noexcept { return static_cast<double>(stride) * levels[level].cellMetres; }
};

/// One Brownian motion, read along a path.
class BrownianMotion {
public:
    explicit BrownianMotion(std::uint64_t key) noexcept : key_(key) {}

    /// Sums of the increments of a block's cells, known at multiples of `stride`.
    template <std::size_t stride>
    [[nodiscard]] const std::array<double, cellsPerBlock + 1>& sumsOf(std::size_t level, std::int64_t block) noexcept {
        return blockAt<stride>(level, block).sums;
    }

private:
    struct Block {
        std::int64_t index = std::numeric_limits<std::int64_t>::min();
        /// Before each cell, and after the last.
        std::array<double, cellsPerBlock + 1> sums{};
    };

    template <std::size_t stride>
    const Block& blockAt(std::size_t level, std::int64_t index) noexcept {
        Block& block = blocks_[level];
        if (block.index != index) {
            block.index = index;
            fill<stride>(block, level);
        }
        return block;
    }

    template <std::size_t stride>
    void fill(Block& block, std::size_t level) noexcept {
        std::uint64_t random = mixed(key_ + static_cast<std::uint64_t>(block.index) * 0x9E3779B97F4A7C15U +
                                     static_cast<std::uint64_t>(level) * 0xD6E8FEB86659FD93U);
        // Each byte gives a number that is uniform, with mean 0 and variance 1: (256^2 - 1) / 12 is 73.9^2. The sum
        // over levels, cells and directions is normal.
        const auto next = [&random] {
            const auto byte = static_cast<double>(static_cast<std::int32_t>(random & 0xFFU));
            random >>= 8U;
            return (byte - 127.5) * (1.0 / 73.900270635041727);
        };
        // The increment of half a cell is half the cell's plus or minus a number of half its deviation, which makes the
        // two halves independent.
        const double cell = levels[level].deviation;
        constexpr double rootOfTwo = 4.0 * rootOfEighth;
        auto& sums = block.sums;
        const double random8 = next();
        sums[8] = level == 0 ? 2.0 * rootOfTwo * cell * random8 : parentIncrement(level, block.index);
        sums[4] = 0.5 * sums[8] + rootOfTwo * cell * next();
        if constexpr (stride <= 2) {
            sums[2] = 0.5 * sums[4] + cell * next();
            sums[6] = 0.5 * (sums[4] + sums[8]) + cell * next();
        }
        if constexpr (stride == 1) {
            for (std::size_t odd = 1; odd < cellsPerBlock; odd += 2) {
                sums[odd] = 0.5 * (sums[odd - 1] + sums[odd + 1]) + 0.5 * rootOfTwo * cell * next();
            }
        }
    }

    double parentIncrement(std::size_t level, std::int64_t cell) noexcept {
        const Block& parent = blockAt<1>(level - 1, cell >> logCellsPerBlock);
        const std::size_t place = static_cast<std::size_t>(cell) % cellsPerBlock;
        return parent.sums[place + 1] - parent.sums[place];
    }

    std::uint64_t key_;
    std::array<Block, levels.size()> blocks_{};
};

/// The part of a segment that is computed at once.
constexpr std::size_t partSamples = 256;
constexpr std::size_t partTimes = partSamples + 2 * noiseReachSamples;

/// The field along a path: the increments of the cells by the time at which the path passes their middles. Each slot of
/// a sample has a row of its own, so that the filter's sum runs over samples that lie beside each other.
using Row = std::array<float, partTimes>;
using Passage = std::array<Row, noiseSlotsPerSample>;

/// The cells that a path passes along one direction, and what it passes across it.
struct Crossing {
    std::int64_t firstCell = 0;
    std::int64_t endCell = 0;
    /// When the middle of cell 0 of `firstCell`'s block is passed, in slots from the part's first.
    double blockSlot = 0.0;
    double slotsPerCell = 0.0;
    double slots = 0.0;
    std::int64_t lowestSheet = 0;
    /// Above that sheet at slot 0, and for each slot.
    double sheet = 0.0;
    double sheetsPerSlot = 0.0;
};

template <std::size_t stride>
void addCells(std::uint64_t key, std::size_t level, const Crossing& crossing, Passage& passage) noexcept {
    constexpr std::int64_t perBlock = cellsPerBlock / stride;
    BrownianMotion motion(key);
    std::int32_t sheet = -1;
    double sign = 1.0;
    double blockSlot = crossing.blockSlot;
    for (std::int64_t block = floorDivided(crossing.firstCell, perBlock); block * perBlock < crossing.endCell;
         ++block) {
        const auto& sums = motion.sumsOf<stride>(level, block);
        for (std::size_t cell = 0; cell < perBlock; ++cell) {
            const double slot = blockSlot + crossing.slotsPerCell * static_cast<double>(cell);
            if (!(slot >= 0.0 && slot < crossing.slots)) {
                continue;
            }
            if (const auto now = static_cast<std::int32_t>(crossing.sheet + crossing.sheetsPerSlot * slot);
                now != sheet) {
                sheet = now;
                // The highest bit of a product depends on every bit of both factors.
                const auto number = static_cast<std::uint64_t>(crossing.lowestSheet + sheet);
                sign = ((number * 0x9E3779B97F4A7C15U ^ key) * 0xD6E8FEB86659FD93U) >> 63U == 0 ? 1.0 : -1.0;
            }
            const auto index = static_cast<std::size_t>(static_cast<std::int32_t>(slot));
            passage[index % noiseSlotsPerSample][index / noiseSlotsPerSample] +=
                static_cast<float>(sign * (sums[(cell + 1) * stride] - sums[cell * stride]));
        }
        blockSlot += crossing.slotsPerCell * static_cast<double>(perBlock);
    }
}

/// `times` counts the part's samples and the filter's reach on both sides.
void addDirection(std::uint64_t surface, std::size_t k, const SurfacePath& path, std::size_t times,
                  Passage& passage) noexcept {
    constexpr auto slotsPerSample = static_cast<double>(noiseSlotsPerSample);
    // The filter is centred on the middle of a sample, and the path is given at its beginning.
    constexpr double firstSample = 0.5 - static_cast<double>(noiseReachSamples);
    const double stepMetres = dot(path.stepMetres, directions[k]);
    const Grid grid(std::abs(stepMetres));
    const double cellsPerSlot = stepMetres / (grid.cellMetres() * slotsPerSample);
    Crossing crossing{.slotsPerCell = 1.0 / cellsPerSlot,
                      .slots = static_cast<double>(times) * slotsPerSample,
                      .sheetsPerSlot = dot(path.stepMetres, across(k)) / (sheetMetres * slotsPerSample)};
    // A path across the direction passes no cell.
    if (!(std::abs(crossing.slotsPerCell) < 1e6)) {
        return;
    }
    const double start =
        dot(path.startMetres, directions[k]) / grid.cellMetres() + firstSample * slotsPerSample * cellsPerSlot;
    const double end = start + crossing.slots * cellsPerSlot;
    const auto cellsOfBlock = static_cast<std::int64_t>(cellsPerBlock / grid.stride);
    crossing.firstCell = static_cast<std::int64_t>(std::floor(std::min(start, end)));
    crossing.endCell = static_cast<std::int64_t>(std::floor(std::max(start, end))) + 1;
    const std::int64_t blockCell = floorDivided(crossing.firstCell, cellsOfBlock) * cellsOfBlock;
    crossing.blockSlot = (static_cast<double>(blockCell) + 0.5 - start) * crossing.slotsPerCell;

    const double sheet =
        dot(path.startMetres, across(k)) / sheetMetres + 0.5 + firstSample * slotsPerSample * crossing.sheetsPerSlot;
    // Counted from the lowest, so that truncation is the floor.
    const double lowest = std::floor(sheet + std::min(0.0, crossing.sheetsPerSlot * crossing.slots));
    crossing.lowestSheet = static_cast<std::int64_t>(lowest);
    crossing.sheet = sheet - lowest;

    const std::uint64_t key = mixed(surface * directionCount + k);
    switch (grid.stride) {
        case 4:
            return addCells<4>(key, grid.level, crossing, passage);
        case 2:
            return addCells<2>(key, grid.level, crossing, passage);
        default:
            return addCells<1>(key, grid.level, crossing, passage);
    }
}

void fillPart(std::uint64_t surface, const SurfacePath& path, std::span<float> noise) noexcept {
    const std::size_t times = noise.size() + 2 * noiseReachSamples;
    Passage passage;
    for (Row& row : passage) {
        std::fill_n(row.begin(), times, 0.0F);
    }
    double variance = 0.0;
    for (std::size_t k = 0; k < directions.size(); ++k) {
        addDirection(surface, k, path, times, passage);
        variance += std::abs(dot(path.stepMetres, directions[k]));
    }
    std::ranges::fill(noise, 0.0F);
    for (std::size_t shift = 0; shift < 2 * noiseReachSamples; ++shift) {
        const float* const gains = noiseKernel.data() + shift * noiseSlotsPerSample;
        for (std::size_t index = 0; index < noise.size(); ++index) {
            float sum = noise[index];
            for (std::size_t slot = 0; slot < noiseSlotsPerSample; ++slot) {
                sum += gains[slot] * passage[slot][index + shift];
            }
            noise[index] = sum;
        }
    }
    const auto scale = static_cast<float>(1.0 / std::sqrt(variance));
    for (float& each : noise) {
        each *= scale;
    }
}

bool isUsable(const Vector& vector) noexcept {
    return std::ranges::all_of(vector, [](double each) { return std::abs(each) <= maximumMetres; });
}

}  // namespace

bool fillSurfaceNoise(std::uint64_t surface, const SurfacePath& path, std::span<float> noise) noexcept {
    const double length = std::sqrt(dot(path.stepMetres, path.stepMetres));
    if (!isUsable(path.startMetres) || !isUsable(path.stepMetres) || !(length >= shortestStepMetres) ||
        !(length <= longestStepMetres)) {
        return false;
    }
    for (std::size_t first = 0; first < noise.size(); first += partSamples) {
        SurfacePath rest = path;
        for (std::size_t axis = 0; axis < rest.startMetres.size(); ++axis) {
            rest.startMetres[axis] += path.stepMetres[axis] * static_cast<double>(first);
        }
        fillPart(surface, rest, noise.subspan(first, std::min(partSamples, noise.size() - first)));
    }
    return true;
}

}  // namespace haptoflow::inference
