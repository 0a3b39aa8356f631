#pragma once

#include "inference/onnx_graph.hpp"
#include "inference/segment_generator.hpp"
#include "inference/shared_sessions.hpp"
#include "model/model_file.hpp"

#include <cstddef>
#include <memory>

namespace haptoflow::inference {

/// Positions of the inputs in the signatures of the graphs.
namespace field_input {
inline constexpr std::size_t noisy = 0;
inline constexpr std::size_t time = 1;
inline constexpr std::size_t previous = 2;
inline constexpr std::size_t embedding = 3;
inline constexpr std::size_t motion = 4;
inline constexpr std::size_t phases = 5;
/// Only in tiers of kind `average-velocity`.
inline constexpr std::size_t interval = 6;
}  // namespace field_input
namespace refinement_input {
inline constexpr std::size_t entering = 0;
inline constexpr std::size_t past = 1;
inline constexpr std::size_t film = 2;
}  // namespace refinement_input
namespace level_input {
inline constexpr std::size_t embedding = 0;
inline constexpr std::size_t motion = 1;
}  // namespace level_input

/// Size of a point of the tier's field: 200, or the size of a latent.
[[nodiscard]] std::size_t pointSize(const model::Tier& tier);

/// Load a graph of a tier and check it against the format. Each throws what OnnxGraph's constructor throws. `sessions`
/// may be null.
[[nodiscard]] OnnxGraph loadField(std::shared_ptr<const Runtime> runtime, const model::ModelFile& model,
                                  const model::Tier& tier, std::size_t maximumBatch, const LoadLimits& limits,
                                  SharedSessions* sessions = nullptr);
[[nodiscard]] OnnxGraph loadLevel(std::shared_ptr<const Runtime> runtime, const model::ModelFile& model,
                                  const model::Tier& tier, std::size_t maximumBatch, const LoadLimits& limits);
/// Tiers of kind `refine` only; `filmSize` numbers condition the graph.
[[nodiscard]] OnnxGraph loadRefinement(std::shared_ptr<const Runtime> runtime, const model::ModelFile& model,
                                       const model::Tier& tier, std::size_t filmSize, std::size_t maximumBatch,
                                       const LoadLimits& limits);
/// Latent tiers only.
[[nodiscard]] OnnxGraph loadEncoder(std::shared_ptr<const Runtime> runtime, const model::ModelFile& model,
                                    const model::Tier& tier, std::size_t maximumBatch, const LoadLimits& limits,
                                    SharedSessions* sessions = nullptr);
[[nodiscard]] OnnxGraph loadDecoder(std::shared_ptr<const Runtime> runtime, const model::ModelFile& model,
                                    const model::Tier& tier, std::size_t maximumBatch, const LoadLimits& limits,
                                    SharedSessions* sessions = nullptr);

/// Solver and number of steps that the model states for the tier.
[[nodiscard]] SolverSettings defaultSolver(const model::Tier& tier) noexcept;

}  // namespace haptoflow::inference
