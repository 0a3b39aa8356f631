#pragma once

#include "model/model_header.hpp"

#include <array>
#include <cstddef>
#include <span>

namespace haptoflow::engine {

/// The points of speed, direction and force at which a material's level is tabulated. Tables are interpolated linearly
/// in direction and in the logarithms of speed and force. Immutable.
class LevelGrid {
public:
    static constexpr std::size_t speeds = 10;
    static constexpr std::size_t directions = 8;
    static constexpr std::size_t forces = 8;
    static constexpr std::size_t points = speeds * directions * forces;
    /// Natural logarithm of the RMS in m/s^2 at each point.
    using Table = std::span<const float, points>;

    explicit LevelGrid(const model::ModelHeader& header) noexcept;

    /// vx, vy in m/s and force in N at a point.
    [[nodiscard]] std::array<float, 3> motionOf(std::size_t point) const noexcept;
    /// The table's value at a motion, which is clamped to the grid.
    [[nodiscard]] double at(Table table, const std::array<float, 3>& motion) const noexcept;

private:
    /// An axis with points spaced evenly over the logarithm.
    struct Axis {
        double lowest = 0.0;
        double highest = 0.0;
        [[nodiscard]] double value(double place) const noexcept;
        [[nodiscard]] double place(double value, std::size_t count) const noexcept;
    };

    Axis speed_;
    Axis force_;
};

}  // namespace haptoflow::engine
