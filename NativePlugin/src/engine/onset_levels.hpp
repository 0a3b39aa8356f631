#pragma once

#include "engine/level_grid.hpp"
#include "inference/load_limits.hpp"
#include "inference/segment_generator.hpp"
#include "model/model_file.hpp"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace haptoflow::engine {

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
