#pragma once

#include "inference/load_limits.hpp"
#include "inference/segment_generator.hpp"
#include "model/model_file.hpp"
#include "model/model_header.hpp"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

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

/// Logarithms of the level graph's levels at the points of the grid for each of `embeddings`, one table after the
/// other. Throws inference::InferenceError, inference::LoadCancelled.
[[nodiscard]] std::vector<float> tabulateLevels(
    const LevelGrid& grid, std::span<const std::span<const float, model::embeddingSize>> embeddings,
    inference::LevelEstimator& estimator, const inference::LoadLimits& limits = {});

/// Tables of the model's level for every label, which give the level of a seed at touch-down without running a graph.
/// Immutable after construction: any thread.
class OnsetLevels {
public:
    /// Evaluates the level graph at 640 points for each embedding that labels use; labels with the same embedding share
    /// a table. Throws inference::InferenceError, inference::LoadCancelled.
    OnsetLevels(const model::ModelFile& model, inference::LevelEstimator& estimator,
                const inference::LoadLimits& limits = {});

    [[nodiscard]] const LevelGrid& grid() const noexcept { return grid_; }
    /// Table of a label of the model.
    [[nodiscard]] LevelGrid::Table table(std::size_t label) const noexcept;

private:
    LevelGrid grid_;
    /// Offset of each label's table in `logLevels_`.
    std::vector<std::size_t> tables_;
    std::vector<float> logLevels_;
};

}  // namespace haptoflow::engine
