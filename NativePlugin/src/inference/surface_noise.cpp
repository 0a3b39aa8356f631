#include "inference/surface_noise.hpp"

#include "inference/hashed_numbers.hpp"

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

/// The part of a segment that is computed at once.
constexpr std::size_t partSamples = 256;

/// The cells of one length that a path along a direction passes, one for each sample's beginning.
class CellRun {
public:
    /// `offset` counts in samples, `count` is at most partSamples + 1.
    CellRun(const SurfacePath& path, const Vector& direction, double cellMetres, double offset,
            std::size_t count) noexcept {
        const double step = dot(path.stepMetres, direction) / cellMetres;
        const double start = dot(path.startMetres, direction) / cellMetres + offset * step;
        const double lowest = std::floor(start + std::min(0.0, step * static_cast<double>(count)));
        first_ = static_cast<std::int64_t>(lowest);
        const double from = start - lowest;
        // Not below zero, so that truncation is the floor, which compilers do for several samples at once.
        for (std::int32_t index = 0; index < static_cast<std::int32_t>(count); ++index) {
            cells_[static_cast<std::size_t>(index)] =
                static_cast<std::int32_t>(from + step * static_cast<double>(index));
        }
    }
    [[nodiscard]] std::int64_t at(std::size_t index) const noexcept { return first_ + cells_[index]; }

private:
    std::int64_t first_ = 0;
    std::array<std::int32_t, partSamples + 1> cells_;
};

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
    BrownianMotion(std::uint64_t key, const Grid& grid, std::int64_t firstPlace) noexcept
        : key_(key), grid_(grid), here_((firstPlace * static_cast<std::int64_t>(grid.stride)) >> logCellsPerBlock) {
        moveTo(here_);
    }

    /// Value at the lower end of a cell of the grid, up to a constant. The time grows with the distance from the last.
    [[nodiscard]] double at(std::int64_t place) noexcept {
        const std::int64_t cell = place * static_cast<std::int64_t>(grid_.stride);
        if (const std::int64_t block = cell >> logCellsPerBlock; block != here_) {
            moveTo(block);
        }
        return base_ + blocks_[grid_.level].sums[static_cast<std::size_t>(cell) % cellsPerBlock];
    }

private:
    struct Block {
        std::int64_t index = std::numeric_limits<std::int64_t>::min();
        /// Sum of the increments of the cells before each, and of all; known at multiples of the stride.
        std::array<double, cellsPerBlock + 1> sums{};
    };

    void moveTo(std::int64_t block) noexcept {
        while (here_ < block) {
            base_ += blockAt(grid_.level, here_, grid_.stride).sums[cellsPerBlock];
            ++here_;
        }
        while (here_ > block) {
            --here_;
            base_ -= blockAt(grid_.level, here_, grid_.stride).sums[cellsPerBlock];
        }
        (void)blockAt(grid_.level, here_, grid_.stride);
    }

    const Block& blockAt(std::size_t level, std::int64_t index, std::size_t stride) noexcept {
        Block& block = blocks_[level];
        if (block.index != index) {
            block.index = index;
            fill(block, level, stride);
        }
        return block;
    }

    void fill(Block& block, std::size_t level, std::size_t stride) noexcept {
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
        if (stride > 2) {
            return;
        }
        sums[2] = 0.5 * sums[4] + cell * next();
        sums[6] = 0.5 * (sums[4] + sums[8]) + cell * next();
        if (stride > 1) {
            return;
        }
        for (std::size_t odd = 1; odd < cellsPerBlock; odd += 2) {
            sums[odd] = 0.5 * (sums[odd - 1] + sums[odd + 1]) + 0.5 * rootOfTwo * cell * next();
        }
    }

    double parentIncrement(std::size_t level, std::int64_t cell) noexcept {
        const Block& parent = blockAt(level - 1, cell >> logCellsPerBlock, 1);
        const std::size_t place = static_cast<std::size_t>(cell) % cellsPerBlock;
        return parent.sums[place + 1] - parent.sums[place];
    }

    std::uint64_t key_;
    Grid grid_;
    std::array<Block, levels.size()> blocks_{};
    std::int64_t here_;
    double base_ = 0.0;
};

/// The sums over all directions for one sample.
struct Sample {
    double increment = 0.0;
    double variance = 0.0;
};

using Part = std::array<Sample, partSamples>;

void addDirection(std::uint64_t surface, std::size_t k, const SurfacePath& path, std::span<Sample> samples) noexcept {
    const std::uint64_t key = mixed(surface * directionCount + k);
    const double stepMetres = dot(path.stepMetres, directions[k]);
    const Grid grid(std::abs(stepMetres));
    const double cellMetres = grid.cellMetres();
    const CellRun along(path, directions[k], cellMetres, 0.0, samples.size() + 1);
    const CellRun sheets(path, across(k), sheetMetres, 0.5, samples.size());
    const std::uint64_t direction = stepMetres < 0.0 ? 1U : 0U;
    std::int64_t before = along.at(0);
    BrownianMotion motion(key, grid, before);
    double valueBefore = motion.at(before);
    for (std::size_t index = 0; index < samples.size(); ++index) {
        const std::int64_t after = along.at(index + 1);
        if (after == before) {
            continue;
        }
        // The highest bit of a product depends on every bit of both factors.
        const std::uint64_t sheet =
            (static_cast<std::uint64_t>(sheets.at(index)) * 0x9E3779B97F4A7C15U ^ key) * 0xD6E8FEB86659FD93U;
        const double sign = ((sheet >> 63U) ^ direction) == 0 ? 1.0 : -1.0;
        const double value = motion.at(after);
        samples[index].increment += sign * (value - valueBefore);
        samples[index].variance +=
            cellMetres * static_cast<double>(static_cast<std::int32_t>(std::abs(after - before)));
        valueBefore = value;
        before = after;
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
    Part part;
    for (std::size_t first = 0; first < noise.size(); first += part.size()) {
        const auto samples = std::span(part).first(std::min(part.size(), noise.size() - first));
        std::ranges::fill(samples, Sample{});
        SurfacePath rest = path;
        for (std::size_t axis = 0; axis < rest.startMetres.size(); ++axis) {
            rest.startMetres[axis] += path.stepMetres[axis] * static_cast<double>(first);
        }
        for (std::size_t k = 0; k < directions.size(); ++k) {
            addDirection(surface, k, rest, samples);
        }
        for (std::size_t index = 0; index < samples.size(); ++index) {
            const Sample& sample = samples[index];
            noise[first + index] =
                sample.variance > 0.0 ? static_cast<float>(sample.increment / std::sqrt(sample.variance)) : 0.0F;
        }
    }
    return true;
}

}  // namespace haptoflow::inference
