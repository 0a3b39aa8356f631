#include "effects/relief_normals.hpp"

#include "dsp/fourier_transform.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <stdexcept>

namespace haptoflow::effects {
namespace {

using Complex = std::complex<double>;

/// Steeper normals lie nearly in the surface and tell no slope.
constexpr double steepestSlope = 20.0;

/// One side of the grid on which a map is integrated: a period of it, in a power of two of points.
struct Side {
    std::size_t texels;
    std::size_t points;
    double periodMetres;
    bool isTiled;

    Side(std::uint32_t count, double sizeMetres, bool tiled)
        : texels(count),
          points(std::bit_ceil((tiled ? 1 : 2) * texels)),
          periodMetres((tiled ? 1.0 : 2.0) * sizeMetres),
          isTiled(tiled) {}

    [[nodiscard]] double period() const noexcept { return static_cast<double>(isTiled ? texels : 2 * texels); }
    /// Where a point lies, in texels from the first one's middle.
    [[nodiscard]] double texelOf(std::size_t point) const noexcept {
        return (static_cast<double>(point) + 0.5) * period() / static_cast<double>(points) - 0.5;
    }
    [[nodiscard]] double pointOf(std::size_t texel) const noexcept {
        return (static_cast<double>(texel) + 0.5) * static_cast<double>(points) / period() - 0.5;
    }
    /// Of a harmonic, in radians per metre; 0 for the fastest, whose slope the points do not tell.
    [[nodiscard]] double wavenumber(std::size_t harmonic) const noexcept {
        const auto half = static_cast<std::ptrdiff_t>(points / 2);
        auto signedHarmonic = static_cast<std::ptrdiff_t>(harmonic);
        signedHarmonic -= signedHarmonic > half ? static_cast<std::ptrdiff_t>(points) : 0;
        return signedHarmonic == half ? 0.0
                                      : 2.0 * std::numbers::pi * static_cast<double>(signedHarmonic) / periodMetres;
    }
};

/// The texel that stands at an index of the repeated or mirrored map, and whether it is mirrored.
struct Source {
    std::size_t texel = 0;
    bool isMirrored = false;
};

Source sourceOf(const Side& side, std::ptrdiff_t index) noexcept {
    const auto count = static_cast<std::ptrdiff_t>(side.texels);
    const std::ptrdiff_t period = side.isTiled ? count : 2 * count;
    const std::ptrdiff_t inPeriod = ((index % period) + period) % period;
    const bool isMirrored = inPeriod >= count;
    return {static_cast<std::size_t>(isMirrored ? period - 1 - inPeriod : inPeriod), isMirrored};
}

/// Two neighbours and the second one's share.
struct Between {
    std::array<std::ptrdiff_t, 2> indices;
    std::array<double, 2> shares;

    explicit Between(double position) noexcept {
        const double whole = std::floor(position);
        indices = {static_cast<std::ptrdiff_t>(whole), static_cast<std::ptrdiff_t>(whole) + 1};
        shares = {1.0 - (position - whole), position - whole};
    }
};

void transform(std::vector<Complex>& values, const Side& across, const Side& down, dsp::Direction direction) {
    std::vector<Complex> line(across.points);
    for (std::size_t row = 0; row < down.points; ++row) {
        const auto first = values.begin() + static_cast<std::ptrdiff_t>(row * across.points);
        std::copy_n(first, across.points, line.begin());
        dsp::fourierTransform(line, direction);
        std::ranges::copy(line, first);
    }
    line.resize(down.points);
    for (std::size_t column = 0; column < across.points; ++column) {
        for (std::size_t row = 0; row < down.points; ++row) {
            line[row] = values[row * across.points + column];
        }
        dsp::fourierTransform(line, direction);
        for (std::size_t row = 0; row < down.points; ++row) {
            values[row * across.points + column] = line[row];
        }
    }
}

/// The slopes along both sides at the grid's points, one the real part and one the imaginary.
std::vector<Complex> slopesOf(std::span<const float> normals, const Side& across, const Side& down) {
    const auto slopeOf = [&](const Source& column, const Source& row) {
        const float* normal = normals.data() + 3 * (row.texel * across.texels + column.texel);
        const double length = std::hypot(normal[0], normal[1], normal[2]);
        const double outwards = std::max(static_cast<double>(normal[2]), length / steepestSlope);
        if (!(outwards > 0.0)) {
            return Complex{};
        }
        return Complex{(column.isMirrored ? 1.0 : -1.0) * static_cast<double>(normal[0]) / outwards,
                       (row.isMirrored ? 1.0 : -1.0) * static_cast<double>(normal[1]) / outwards};
    };
    std::vector<Complex> slopes(across.points * down.points);
    for (std::size_t row = 0; row < down.points; ++row) {
        const Between rows(down.texelOf(row));
        for (std::size_t column = 0; column < across.points; ++column) {
            const Between columns(across.texelOf(column));
            Complex& slope = slopes[row * across.points + column];
            for (std::size_t y = 0; y < 2; ++y) {
                for (std::size_t x = 0; x < 2; ++x) {
                    slope += rows.shares[y] * columns.shares[x] *
                             slopeOf(sourceOf(across, columns.indices[x]), sourceOf(down, rows.indices[y]));
                }
            }
        }
    }
    return slopes;
}

}  // namespace

std::vector<float> heightsOfNormals(std::span<const float> normals, std::uint32_t columns, std::uint32_t rows,
                                    std::array<double, 2> sizeMetres, bool isTiled) {
    if (columns == 0 || rows == 0 || normals.size() != std::size_t{3} * columns * rows) {
        throw std::invalid_argument("a normal map needs three numbers for each of its texels");
    }
    if (!(sizeMetres[0] > 0.0 && sizeMetres[1] > 0.0)) {
        throw std::invalid_argument("a normal map's size is above 0 along both sides");
    }
    if (!std::ranges::all_of(normals, [](float number) { return std::isfinite(number); })) {
        throw std::invalid_argument("a normal map's numbers are finite");
    }
    const Side across(columns, sizeMetres[0], isTiled);
    const Side down(rows, sizeMetres[1], isTiled);
    std::vector<Complex> both = slopesOf(normals, across, down);
    transform(both, across, down, dsp::Direction::forward);
    std::vector<Complex> heights(both.size());
    for (std::size_t row = 0; row < down.points; ++row) {
        for (std::size_t column = 0; column < across.points; ++column) {
            // Two real signals share a transform: the one's is its part that is even under reversal.
            const Complex here = both[row * across.points + column];
            const Complex there = std::conj(
                both[((down.points - row) % down.points) * across.points + (across.points - column) % across.points]);
            const double x = across.wavenumber(column);
            const double y = down.wavenumber(row);
            if (x != 0.0 || y != 0.0) {
                const Complex along = 0.5 * (here + there);
                const Complex aside = Complex{0.0, -0.5} * (here - there);
                heights[row * across.points + column] = Complex{0.0, -1.0} * (x * along + y * aside) / (x * x + y * y);
            }
        }
    }
    transform(heights, across, down, dsp::Direction::inverse);
    std::vector<float> result;
    result.reserve(std::size_t{columns} * rows);
    for (std::size_t row = 0; row < rows; ++row) {
        const Between below(down.pointOf(row));
        for (std::size_t column = 0; column < columns; ++column) {
            const Between beside(across.pointOf(column));
            double height = 0.0;
            for (std::size_t y = 0; y < 2; ++y) {
                for (std::size_t x = 0; x < 2; ++x) {
                    const std::size_t line =
                        static_cast<std::size_t>(below.indices[y] + static_cast<std::ptrdiff_t>(down.points)) %
                        down.points;
                    const std::size_t point =
                        static_cast<std::size_t>(beside.indices[x] + static_cast<std::ptrdiff_t>(across.points)) %
                        across.points;
                    height += below.shares[y] * beside.shares[x] * heights[line * across.points + point].real();
                }
            }
            result.push_back(static_cast<float>(height));
        }
    }
    const float lowest = *std::ranges::min_element(result);
    std::ranges::for_each(result, [lowest](float& height) { height -= lowest; });
    return result;
}

}  // namespace haptoflow::effects
