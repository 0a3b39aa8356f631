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

/// The level graph's answers at the points of the grid for each of `embeddings`, one table after the other. Throws
/// inference::InferenceError, inference::LoadCancelled.
[[nodiscard]] std::vector<float> tabulateLevels(
    const LevelGrid& grid, std::span<const std::span<const float, model::embeddingSize>> embeddings,
    inference::LevelEstimator& estimator, const inference::LoadLimits& limits = {});

/// The model's level for every label, tabulated, so that a touch-down can level its seed without running a graph.
/// Immutable after construction: any thread.
class OnsetLevels {
public:
    /// Asks the level graph 640 times for each material embedding that a label names; labels that name the same one
    /// share its table. Throws inference::InferenceError, inference::LoadCancelled.
    OnsetLevels(const model::ModelFile& model, inference::LevelEstimator& estimator,
                const inference::LoadLimits& limits = {});

    [[nodiscard]] const LevelGrid& grid() const noexcept { return grid_; }
    /// Of a label of the model.
    [[nodiscard]] LevelGrid::Table table(std::size_t label) const noexcept;

private:
    LevelGrid grid_;
    /// Of each label, where its levels begin.
    std::vector<std::size_t> tables_;
    std::vector<float> logLevels_;
};

}  // namespace haptoflow::engine
