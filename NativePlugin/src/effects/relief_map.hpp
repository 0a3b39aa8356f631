#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace haptoflow::effects {

/// What a relief's heights mean.
struct ReliefDescription {
    std::uint32_t columns = 0;
    std::uint32_t rows = 0;
    /// Length of the whole map along its columns (u) and rows (v), where its objects have their usual size.
    std::array<double, 2> sizeMetres{};
    /// Heights lie within this range.
    double depthMetres = 0.0;
    /// Radius of the tip's sphere; 0 for a point.
    double tipRadiusMetres = 0.0;
    /// Whether the map goes on at its rims with the opposite one; otherwise the rim's heights go on.
    bool isTiled = false;
};

/// The surface that the centre of a tip's sphere follows over a map of heights: a dilation by the sphere, in several
/// resolutions. Immutable; any thread reads.
///
/// The sphere is taken as its paraboloid: H(x) = max over o of h(x + o) - |o|^2 / 2r. Where a step is low beside the
/// radius the two agree, and over a higher one the slope is that of the law that bounds a tip's approach to a step,
/// sqrt(2 h / r). Heights between texels are a cubic spline's, so that slopes are continuous.
class ReliefMap {
public:
    static constexpr std::size_t maximumTexels = std::size_t{3} << 20U;

    /// Throws std::invalid_argument for a map without or with too many texels.
    static void requireTexels(std::uint32_t columns, std::uint32_t rows);

    /// `heightsMetres`: columns * rows, row by row, the first row at v = 0. Throws std::invalid_argument for a map
    /// without or with too many texels, a size or depth that is not above 0, and numbers that are not finite.
    ReliefMap(std::span<const float> heightsMetres, const ReliefDescription& description);

    /// The resolution for a tip that passes so many of the finest texels: how often it is halved, with the share of the
    /// next halving. What passes faster than a tip can feel is averaged.
    [[nodiscard]] double resolutionFor(double texelsPerSecond) const noexcept;
    /// Height at a place, whose coordinates are 0 to 1 over the map; any within +-10^9 has one. No allocation.
    [[nodiscard]] double heightMetres(std::array<double, 2> place, double resolution = 0.0) const noexcept;

    [[nodiscard]] const ReliefDescription& description() const noexcept { return description_; }
    [[nodiscard]] std::size_t bytes() const noexcept;

private:
    /// Coefficients of the spline in one resolution.
    struct Level {
        std::int64_t columns = 0;
        std::int64_t rows = 0;
        std::vector<float> coefficients;
    };

    [[nodiscard]] double sample(const Level& level, std::array<double, 2> place) const noexcept;

    ReliefDescription description_;
    /// From the finest on, each half as fine as the one before.
    std::vector<Level> levels_;
};

}  // namespace haptoflow::effects
