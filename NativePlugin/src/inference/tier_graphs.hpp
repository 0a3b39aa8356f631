#pragma once

#include "inference/onnx_graph.hpp"
#include "inference/segment_generator.hpp"
#include "model/model_file.hpp"

#include <cstddef>
#include <memory>

namespace haptoflow::inference {

/// Positions of the inputs in the signatures below.
namespace field_input {
inline constexpr std::size_t noisy = 0;
inline constexpr std::size_t time = 1;
inline constexpr std::size_t previous = 2;
inline constexpr std::size_t embedding = 3;
inline constexpr std::size_t motion = 4;
inline constexpr std::size_t ribPhase = 5;
/// Kind `average-velocity` only.
inline constexpr std::size_t interval = 6;
}  // namespace field_input
namespace level_input {
inline constexpr std::size_t embedding = 0;
inline constexpr std::size_t motion = 1;
}  // namespace level_input

/// Numbers in one point of the tier's field: 200, or those of one latent.
[[nodiscard]] std::size_t pointSize(const model::Tier& tier);

/// The graphs of one tier, loaded and checked against the format. Each throws what OnnxGraph's
/// constructor throws.
[[nodiscard]] OnnxGraph loadField(std::shared_ptr<const Runtime> runtime, const model::ModelFile& model,
                                  const model::Tier& tier, std::size_t maximumBatch, const LoadLimits& limits);
[[nodiscard]] OnnxGraph loadLevel(std::shared_ptr<const Runtime> runtime, const model::ModelFile& model,
                                  const model::Tier& tier, std::size_t maximumBatch, const LoadLimits& limits);
/// Latent tiers only.
[[nodiscard]] OnnxGraph loadEncoder(std::shared_ptr<const Runtime> runtime, const model::ModelFile& model,
                                    const model::Tier& tier, std::size_t maximumBatch, const LoadLimits& limits);
[[nodiscard]] OnnxGraph loadDecoder(std::shared_ptr<const Runtime> runtime, const model::ModelFile& model,
                                    const model::Tier& tier, std::size_t maximumBatch, const LoadLimits& limits);

/// The solver that the tier names as its own.
[[nodiscard]] SolverSettings defaultSolver(const model::Tier& tier) noexcept;

}  // namespace haptoflow::inference
