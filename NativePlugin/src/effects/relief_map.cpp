#include "effects/relief_map.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

namespace haptoflow::effects {
namespace {

/// A tip feels up to 1 kHz; a texel that passes in less than this is averaged with its neighbours.
constexpr double mostTexelsPerSecond = 3000.0;

std::int64_t wrapped(std::int64_t index, std::int64_t count, bool isTiled) noexcept {
    if (!isTiled) {
        return std::clamp<std::int64_t>(index, 0, count - 1);
    }
    if (index >= -count && index < 2 * count) {
        // The usual case, without a division.
        return index + (index < 0 ? count : 0) - (index >= count ? count : 0);
    }
    const std::int64_t rest = index % count;
    return rest < 0 ? rest + count : rest;
}

/// As std::floor, which is a call where the processor has no instruction for it.
std::int64_t wholeBelow(double value) noexcept {
    const auto whole = static_cast<std::int64_t>(value);
    return whole - (value < static_cast<double>(whole) ? 1 : 0);
}

/// A row or a column of a map.
struct Line {
    float* first = nullptr;
    std::int64_t count = 0;
    std::int64_t stride = 0;

    [[nodiscard]] float& operator[](std::int64_t index) const noexcept { return first[index * stride]; }
};

template <typename Visit>
void forEachLine(std::vector<float>& texels, std::int64_t columns, std::int64_t rows, const Visit& visit) {
    for (std::int64_t row = 0; row < rows; ++row) {
        visit(Line{texels.data() + row * columns, columns, 1}, 0);
    }
    for (std::int64_t column = 0; column < columns; ++column) {
        visit(Line{texels.data() + column, rows, columns}, 1);
    }
}

/// max over o of h(x + o) - o^2 curvature / 2, o within `reach` texels. Exact, because the paraboloid is separable.
void dilate(const Line& line, double curvature, std::int64_t reach, bool isTiled, std::vector<float>& before) {
    before.resize(static_cast<std::size_t>(line.count));
    for (std::int64_t index = 0; index < line.count; ++index) {
        before[static_cast<std::size_t>(index)] = line[index];
    }
    for (std::int64_t offset = -reach; offset <= reach; ++offset) {
        const auto lower = static_cast<float>(0.5 * curvature * static_cast<double>(offset * offset));
        for (std::int64_t index = 0; offset != 0 && index < line.count; ++index) {
            const auto from = static_cast<std::size_t>(wrapped(index + offset, line.count, isTiled));
            line[index] = std::max(line[index], before[from] - lower);
        }
    }
}

/// Turns samples into coefficients of a cubic spline that passes through them (Unser, "Splines: a perfect fit for
/// signal and image processing", 1999).
void toSpline(const Line& line, bool isTiled, std::vector<double>& forward) {
    constexpr double pole = std::numbers::sqrt3 - 2.0;
    // Beyond this the pole's powers are below a float's precision.
    constexpr std::int64_t horizon = 16;
    const auto sampleAt = [&](std::int64_t index) {
        return static_cast<double>(line[wrapped(index, line.count, isTiled)]);
    };
    double recursion = 0.0;
    for (std::int64_t index = -horizon; index < 0; ++index) {
        recursion = sampleAt(index) + pole * recursion;
    }
    forward.clear();
    for (std::int64_t index = 0; index < line.count + horizon; ++index) {
        recursion = sampleAt(index) + pole * recursion;
        forward.push_back(recursion);
    }
    recursion = 0.0;
    for (std::int64_t index = line.count + horizon - 1; index >= 0; --index) {
        recursion = pole * (recursion - forward[static_cast<std::size_t>(index)]);
        if (index < line.count) {
            line[index] = static_cast<float>(6.0 * recursion);
        }
    }
}

/// The means of a line's texels over `count` equal parts of it.
std::vector<float> averaged(const Line& line, std::int64_t count) {
    std::vector<float> means;
    means.reserve(static_cast<std::size_t>(count));
    const double width = static_cast<double>(line.count) / static_cast<double>(count);
    for (std::int64_t part = 0; part < count; ++part) {
        const double from = width * static_cast<double>(part);
        const double until = width * static_cast<double>(part + 1);
        double sum = 0.0;
        for (auto index = static_cast<std::int64_t>(from); index < line.count; ++index) {
            const double share =
                std::min(until, static_cast<double>(index + 1)) - std::max(from, static_cast<double>(index));
            if (share <= 0.0) {
                break;
            }
            sum += share * static_cast<double>(line[index]);
        }
        means.push_back(static_cast<float>(sum / width));
    }
    return means;
}

/// A map of half as many columns and rows.
std::vector<float> halved(std::vector<float>& texels, std::int64_t columns, std::int64_t rows) {
    const std::int64_t fewerColumns = (columns + 1) / 2;
    const std::int64_t fewerRows = (rows + 1) / 2;
    std::vector<float> narrow;
    narrow.reserve(static_cast<std::size_t>(fewerColumns * rows));
    for (std::int64_t row = 0; row < rows; ++row) {
        const std::vector<float> means = averaged({texels.data() + row * columns, columns, 1}, fewerColumns);
        narrow.insert(narrow.end(), means.begin(), means.end());
    }
    std::vector<float> result(static_cast<std::size_t>(fewerColumns * fewerRows));
    for (std::int64_t column = 0; column < fewerColumns; ++column) {
        const std::vector<float> means = averaged({narrow.data() + column, rows, fewerColumns}, fewerRows);
        const Line out{result.data() + column, fewerRows, fewerColumns};
        for (std::int64_t row = 0; row < fewerRows; ++row) {
            out[row] = means[static_cast<std::size_t>(row)];
        }
    }
    return result;
}

/// Weights of a cubic B-spline for the four texels around a place.
std::array<double, 4> splineWeights(double fraction) noexcept {
    const double rest = 1.0 - fraction;
    const double square = fraction * fraction;
    const double restSquare = rest * rest;
    return {restSquare * rest / 6.0, 2.0 / 3.0 - 0.5 * square * (2.0 - fraction),
            2.0 / 3.0 - 0.5 * restSquare * (2.0 - rest), square * fraction / 6.0};
}

}  // namespace

void ReliefMap::requireTexels(std::uint32_t columns, std::uint32_t rows) {
    if (columns == 0 || rows == 0 || std::size_t{columns} * rows > maximumTexels) {
        throw std::invalid_argument("a relief has 1 to " + std::to_string(maximumTexels) + " texels, not " +
                                    std::to_string(columns) + " x " + std::to_string(rows) +
                                    "; use a map of another size");
    }
}

ReliefMap::ReliefMap(std::span<const float> heightsMetres, const ReliefDescription& description)
    : description_(description) {
    requireTexels(description.columns, description.rows);
    if (heightsMetres.size() != std::size_t{description.columns} * description.rows) {
        throw std::invalid_argument("a relief needs a height for each of its texels");
    }
    const auto isLength = [](double metres) { return metres > 0.0 && metres <= 1e4; };
    if (!std::ranges::all_of(description.sizeMetres, isLength)) {
        throw std::invalid_argument("a relief's size is above 0 and at most 10 km along both sides");
    }
    if (!(description.depthMetres > 0.0 && description.depthMetres <= 1.0)) {
        throw std::invalid_argument("a relief's depth is above 0 and at most 1 m");
    }
    if (!(description.tipRadiusMetres >= 0.0 && description.tipRadiusMetres <= 0.05)) {
        throw std::invalid_argument("a tip's radius is 0 to 0.05 m");
    }
    if (!std::ranges::all_of(heightsMetres, [](float height) { return std::isfinite(height); })) {
        throw std::invalid_argument("a relief's heights are finite numbers");
    }
    std::vector<float> texels(heightsMetres.begin(), heightsMetres.end());
    const auto depth = static_cast<float>(description.depthMetres);
    std::ranges::for_each(texels, [depth](float& height) { height = std::clamp(height, 0.0F, depth); });
    std::int64_t columns = description.columns;
    std::int64_t rows = description.rows;
    if (description.tipRadiusMetres > 0.0) {
        const double reachMetres = std::sqrt(2.0 * description.tipRadiusMetres * description.depthMetres);
        std::vector<float> scratch;
        forEachLine(texels, columns, rows, [&](const Line& line, std::size_t side) {
            const double texelMetres = description.sizeMetres[side] / static_cast<double>(line.count);
            const auto reach = std::min<std::int64_t>(
                line.count, static_cast<std::int64_t>(std::min(1e6, std::floor(reachMetres / texelMetres))));
            dilate(line, texelMetres * texelMetres / description.tipRadiusMetres, reach, description.isTiled, scratch);
        });
    }
    std::vector<double> forward;
    while (true) {
        Level& level = levels_.emplace_back(Level{columns, rows, texels});
        forEachLine(level.coefficients, columns, rows,
                    [&](const Line& line, std::size_t) { toSpline(line, description.isTiled, forward); });
        if (columns == 1 && rows == 1) {
            return;
        }
        texels = halved(texels, columns, rows);
        columns = (columns + 1) / 2;
        rows = (rows + 1) / 2;
    }
}

double ReliefMap::resolutionFor(double texelsPerSecond) const noexcept {
    const double halvings = std::log2(std::max(1.0, texelsPerSecond) / mostTexelsPerSecond);
    return std::clamp(halvings, 0.0, static_cast<double>(levels_.size() - 1));
}

double ReliefMap::heightMetres(std::array<double, 2> place, double resolution) const noexcept {
    const auto level = static_cast<std::size_t>(resolution);
    const double share = resolution - static_cast<double>(level);
    const double height = sample(levels_[level], place);
    return share > 0.0 ? height + share * (sample(levels_[level + 1], place) - height) : height;
}

double ReliefMap::sample(const Level& level, std::array<double, 2> place) const noexcept {
    const std::array<std::int64_t, 2> counts{level.columns, level.rows};
    std::array<std::array<std::int64_t, 4>, 2> indices{};
    std::array<std::array<double, 4>, 2> weights{};
    for (std::size_t side = 0; side < 2; ++side) {
        const double inMap = description_.isTiled ? place[side] - static_cast<double>(wholeBelow(place[side]))
                                                  : std::clamp(place[side], -1.0, 2.0);
        const double texel = inMap * static_cast<double>(counts[side]) - 0.5;
        const std::int64_t whole = wholeBelow(texel);
        weights[side] = splineWeights(texel - static_cast<double>(whole));
        for (std::size_t tap = 0; tap < 4; ++tap) {
            indices[side][tap] =
                wrapped(whole + static_cast<std::int64_t>(tap) - 1, counts[side], description_.isTiled);
        }
    }
    double height = 0.0;
    for (std::size_t row = 0; row < 4; ++row) {
        const float* texels = level.coefficients.data() + indices[1][row] * level.columns;
        const auto term = [&](std::size_t column) {
            return weights[0][column] * static_cast<double>(texels[indices[0][column]]);
        };
        height += weights[1][row] * ((term(0) + term(1)) + (term(2) + term(3)));
    }
    return height;
}

std::size_t ReliefMap::bytes() const noexcept {
    std::size_t sum = sizeof(*this);
    for (const Level& level : levels_) {
        sum += level.coefficients.size() * sizeof(float);
    }
    return sum;
}

}  // namespace haptoflow::effects
