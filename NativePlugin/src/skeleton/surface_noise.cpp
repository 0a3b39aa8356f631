#include "skeleton/surface_noise.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <utility>

namespace haptoflow::skeleton {
namespace {

using Vector = std::array<double, 3>;

constexpr std::size_t directionCount = 12;
constexpr auto slotsPerSample = static_cast<double>(noiseSlotsPerSample);
// A lag is made up for within 8 samples. It is at most half of their way, so that reading always moves forward.
constexpr double longestLagSamples = 4.0;
constexpr int logCellsPerBlock = 3;
// A longer coordinate would leave the integers that a double holds exactly.
constexpr double maximumMetres = 1e6;
// Across its direction, each Brownian motion changes sign at random from one sheet to the next. Without that, a path
// beside another would meet a twelfth of the other's noise again, at a distance.
constexpr double sheetsPerMetre = 1000.0;

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

std::int64_t roundedUp(double value) noexcept {
    const auto truncated = static_cast<std::int64_t>(value);
    return static_cast<double>(truncated) < value ? truncated + 1 : truncated;
}

/// Cells of one size. Each is divided into the eight cells of a block of the next level.
struct Level {
    double cellMetres = 0.0;
    /// Deviation of a cell's increment.
    double deviation = 0.0;
    double cellsPerMetre = 1.0 / cellMetres;
};

// From 7.8 mm to 30 nm, a twentieth of a sample's way at 1 mm/s. 0.3535534 is the root of an eighth.
constexpr double rootOfEighth = 0.35355339059327379;
constexpr std::array<Level, BrownianMotion::levelCount> levels{{
    {0x1p-7, 0x1p-3 * 2.0 * rootOfEighth},
    {0x1p-10, 0x1p-5},
    {0x1p-13, 0x1p-5 * rootOfEighth},
    {0x1p-16, 0x1p-8},
    {0x1p-19, 0x1p-8 * rootOfEighth},
    {0x1p-22, 0x1p-11},
    {0x1p-25, 0x1p-11 * rootOfEighth},
}};

/// A number of mean 0 and variance 1 for each random byte: the count of its one bits, whose distribution is nearly
/// normal. Large values decide how often impulses come, since an impulse comes where the noise exceeds three
/// deviations; with bytes as uniform numbers, a fifth of the values beyond 3.5 deviations would be missing.
constexpr std::array<double, 256> numbersOfBytes = [] {
    std::array<double, 256> numbers{};
    for (std::size_t byte = 0; byte < numbers.size(); ++byte) {
        numbers[byte] = (std::popcount(byte) - 4) * (2.0 * rootOfEighth);
    }
    return numbers;
}();

constexpr double dot(const Vector& a, const Vector& b) noexcept {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// A direction across each direction.
constexpr std::array<Vector, directionCount> across = [] {
    std::array<Vector, directionCount> products{};
    for (std::size_t k = 0; k < directionCount; ++k) {
        const Vector& a = directions[k];
        const Vector& b = directions[(k + 5) % directionCount];
        products[k] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    }
    return products;
}();

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
    [[nodiscard]] double cellsPerMetre() const noexcept {
        return levels[level].cellsPerMetre / static_cast<double>(stride);
    }
};

/// What a path passes along one direction and across it, from its first slot of time on.
struct Crossing {
    /// Where the path is, in cells, at the first slot's beginning and after the last.
    double start = 0.0;
    double end = 0.0;
    double slotsPerCell = 0.0;
    std::int64_t lowestSheet = 0;
    /// Above that sheet at slot 0, and for each slot.
    double sheet = 0.0;
    double sheetsPerSlot = 0.0;
};

/// Adds the cells' increments times `scale` to the slots in which the path passes their middles.
void addCells(BrownianMotion& motion, const Grid& grid, const Crossing& crossing, double scale,
              std::span<float> slots) noexcept {
    const std::size_t stride = grid.stride;
    const auto perBlock = static_cast<std::int64_t>(BrownianMotion::cellsPerBlock / stride);
    const std::int64_t endCell = roundedUp(std::max(crossing.start, crossing.end) - 0.5);
    std::int64_t cell = roundedUp(std::min(crossing.start, crossing.end) - 0.5);
    const auto lastSlot = static_cast<double>(slots.size()) - 0.5;
    const auto sheetAt = [&crossing](double slot) {
        return static_cast<std::int32_t>(crossing.sheet + crossing.sheetsPerSlot * slot);
    };
    const auto signedAs = [&](std::int32_t sheet) {
        // The highest bit of a product depends on every bit of both factors.
        const auto number = static_cast<std::uint64_t>(crossing.lowestSheet + sheet);
        return ((number * 0x9E3779B97F4A7C15U ^ motion.key()) * 0xD6E8FEB86659FD93U) >> 63U == 0 ? scale : -scale;
    };
    std::int32_t sheet = sheetAt(0.0);
    const bool isOneSheet = sheet == sheetAt(lastSlot + 0.5);
    double signedScale = signedAs(sheet);
    while (cell < endCell) {
        const std::int64_t block = floorDivided(cell, perBlock);
        const auto& sums = motion.sumsOf(grid.level, block, stride);
        const std::int64_t blockCell = block * perBlock;
        const auto end = static_cast<std::size_t>(std::min(endCell - blockCell, perBlock));
        double slot = (static_cast<double>(cell) + 0.5 - crossing.start) * crossing.slotsPerCell;
        for (auto place = static_cast<std::size_t>(cell - blockCell); place < end; ++place) {
            // Rounding may carry a middle at an end of the path out of it.
            const double inside = std::min(std::max(slot, 0.0), lastSlot);
            if (!isOneSheet && sheetAt(slot) != sheet) {
                sheet = sheetAt(slot);
                signedScale = signedAs(sheet);
            }
            slots[static_cast<std::size_t>(static_cast<std::int32_t>(inside))] +=
                static_cast<float>(signedScale * (sums[(place + 1) * stride] - sums[place * stride]));
            slot += crossing.slotsPerCell;
        }
        cell = blockCell + perBlock;
    }
}

bool isUsable(const Vector& vector) noexcept {
    return std::ranges::all_of(vector, [](double each) { return std::abs(each) <= maximumMetres; });
}

bool isUsable(const SurfacePath& path) noexcept {
    const double length = std::sqrt(dot(path.stepMetres, path.stepMetres));
    return isUsable(path.startMetres) && isUsable(path.stepMetres) && length >= shortestStepMetres &&
           length <= longestStepMetres;
}

}  // namespace

const BrownianMotion::Sums& BrownianMotion::sumsOf(std::size_t level, std::int64_t block, std::size_t stride) noexcept {
    Block& known = blocks_[level];
    if (known.index != block || known.stride > stride) {
        known.index = block;
        known.stride = stride;
        fill(known, level);
    }
    return known.sums;
}

void BrownianMotion::fill(Block& block, std::size_t level) noexcept {
    std::uint64_t random = mixed(key_ + static_cast<std::uint64_t>(block.index) * 0x9E3779B97F4A7C15U +
                                 static_cast<std::uint64_t>(level) * 0xD6E8FEB86659FD93U);
    const auto next = [&random] {
        const auto byte = static_cast<std::size_t>(random & 0xFFU);
        random >>= 8U;
        return numbersOfBytes[byte];
    };
    // The increment of half a cell is half the cell's plus or minus a number of half its deviation, which makes the
    // two halves independent.
    const double cell = levels[level].deviation;
    constexpr double rootOfTwo = 4.0 * rootOfEighth;
    Sums& sums = block.sums;
    const double random8 = next();
    sums[8] = level == 0 ? 2.0 * rootOfTwo * cell * random8 : parentIncrement(level, block.index);
    sums[4] = 0.5 * sums[8] + rootOfTwo * cell * next();
    if (block.stride <= 2) {
        sums[2] = 0.5 * sums[4] + cell * next();
        sums[6] = 0.5 * (sums[4] + sums[8]) + cell * next();
    }
    if (block.stride == 1) {
        for (std::size_t odd = 1; odd < cellsPerBlock; odd += 2) {
            sums[odd] = 0.5 * (sums[odd - 1] + sums[odd + 1]) + 0.5 * rootOfTwo * cell * next();
        }
    }
}

double BrownianMotion::parentIncrement(std::size_t level, std::int64_t cell) noexcept {
    const Sums& parent = sumsOf(level - 1, cell >> logCellsPerBlock, 1);
    const std::size_t place = static_cast<std::size_t>(cell) % cellsPerBlock;
    return parent[place + 1] - parent[place];
}

void SurfaceNoise::readCells(std::uint64_t surface, const Vector& to, std::span<float> slots) noexcept {
    const auto slotCount = static_cast<double>(slots.size());
    const Vector from = std::exchange(readMetres_, to);
    Vector slotMetres{};
    for (std::size_t axis = 0; axis < slotMetres.size(); ++axis) {
        slotMetres[axis] = (to[axis] - from[axis]) / slotCount;
    }
    std::array<double, directionCount> ways{};
    double variance = 0.0;
    for (std::size_t k = 0; k < directionCount; ++k) {
        ways[k] = dot(slotMetres, directions[k]);
        variance += std::abs(ways[k]) * slotsPerSample;
    }
    const double scale = 1.0 / std::sqrt(variance);
    for (std::size_t k = 0; k < directionCount; ++k) {
        const Grid grid(std::abs(ways[k]) * slotsPerSample);
        const double cellsPerSlot = ways[k] * grid.cellsPerMetre();
        const double slotsPerCell = 1.0 / cellsPerSlot;
        // A path across the direction passes no cell.
        if (!(std::abs(slotsPerCell) < 1e6)) {
            continue;
        }
        const double sheetsPerSlot = dot(slotMetres, across[k]) * sheetsPerMetre;
        const double sheet = dot(from, across[k]) * sheetsPerMetre + 0.5;
        // Counted from below the lowest, so that truncation is the floor.
        const std::int64_t lowest = roundedUp(sheet + std::min(0.0, sheetsPerSlot * slotCount)) - 1;
        const Crossing crossing{.start = dot(from, directions[k]) * grid.cellsPerMetre(),
                                .end = dot(to, directions[k]) * grid.cellsPerMetre(),
                                .slotsPerCell = slotsPerCell,
                                .lowestSheet = lowest,
                                .sheet = sheet - static_cast<double>(lowest),
                                .sheetsPerSlot = sheetsPerSlot};

        BrownianMotion& motion = motions_[k];
        if (const std::uint64_t key = mixed(surface * directionCount + k); motion.key() != key) {
            motion = BrownianMotion(key);
        }
        addCells(motion, grid, crossing, scale, slots);
    }
}

void SurfaceNoise::readAlong(std::uint64_t surface, const SurfacePath& path, std::span<float> slots) noexcept {
    // The filter is centred on the middle of a sample, and the path is given at its beginning.
    constexpr double aheadSamples = static_cast<double>(noiseReachSamples) - 0.5;
    const auto placeAfter = [&](double samples) {
        Vector place{};
        for (std::size_t axis = 0; axis < place.size(); ++axis) {
            place[axis] = path.startMetres[axis] + path.stepMetres[axis] * samples + lagMetres_[axis];
        }
        return place;
    };
    if (!isPrimed_) {
        lagSamples_ = 0;
        lagMetres_ = {};
        readMetres_ = placeAfter(-aheadSamples);
    } else if (isNewPath_) {
        lagMetres_ = {};
        const Vector wanted = placeAfter(aheadSamples);
        std::ranges::transform(readMetres_, wanted, lagMetres_.begin(), std::minus());
        const double wayOfStep = dot(path.stepMetres, path.stepMetres);
        lagSamples_ = noiseReachSamples;
        if (!(dot(lagMetres_, lagMetres_) <= longestLagSamples * longestLagSamples * wayOfStep)) {
            lagSamples_ = 0;
            lagMetres_ = {};
            readMetres_ = wanted;
        }
    }
    isNewPath_ = false;

    const std::size_t samples = slots.size() / noiseSlotsPerSample;
    // Where the first slot begins.
    const double first = isPrimed_ ? aheadSamples : -aheadSamples;
    isPrimed_ = true;
    for (std::size_t done = 0; done < samples;) {
        std::size_t piece = samples - done;
        if (lagSamples_ > 0) {
            piece = std::min(piece, lagSamples_);
            const double kept = static_cast<double>(lagSamples_ - piece) / static_cast<double>(lagSamples_);
            std::ranges::for_each(lagMetres_, [kept](double& metres) { metres *= kept; });
            lagSamples_ -= piece;
        }
        readCells(surface, placeAfter(first + static_cast<double>(done + piece)),
                  slots.subspan(done * noiseSlotsPerSample, piece * noiseSlotsPerSample));
        done += piece;
    }
}

void SurfaceNoise::skip(std::size_t samples) noexcept {
    numbers_ += samples;
    isPrimed_ = false;
}

void SurfaceNoise::next(std::uint64_t surface, const SurfacePath& path, const NoiseKey& otherwise,
                        std::span<float> noise) noexcept {
    const std::uint64_t first = std::exchange(numbers_, numbers_ + noise.size());
    if (!isUsable(path)) {
        fillStandardNormal(otherwise, noise, first);
        isPrimed_ = false;
        return;
    }
    const auto passage = std::span(passage_).first(memorySlots + noise.size() * noiseSlotsPerSample);
    const std::size_t known = isPrimed_ ? memorySamples : 0;
    const auto slots = passage.subspan(known * noiseSlotsPerSample);
    std::ranges::fill(slots, 0.0F);
    readAlong(surface, path, slots);

    for (std::size_t n = 0; n < noise.size(); ++n) {
        const float* const passed = passage.data() + n * noiseSlotsPerSample;
        // A sum for each slot of a sample, so that they are computed beside each other.
        std::array<float, noiseSlotsPerSample> sums{};
        for (std::size_t tap = 0; tap < noiseKernel.size(); tap += sums.size()) {
            for (std::size_t slot = 0; slot < sums.size(); ++slot) {
                sums[slot] += noiseKernel[tap + slot] * passed[tap + slot];
            }
        }
        noise[n] = ((sums[0] + sums[4]) + (sums[1] + sums[5])) + ((sums[2] + sums[6]) + (sums[3] + sums[7]));
    }
    std::ranges::copy(passage.last(memorySlots), passage.begin());
}

}  // namespace haptoflow::skeleton
