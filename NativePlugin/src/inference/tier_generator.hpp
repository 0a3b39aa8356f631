#pragma once

#include "inference/graph_session.hpp"
#include "inference/load_limits.hpp"
#include "inference/onnx_runtime.hpp"
#include "inference/segment_generator.hpp"
#include "model/model_file.hpp"
#include "skeleton/skeleton_tensors.hpp"

#include <cstddef>
#include <memory>

namespace haptoflow::inference {

inline constexpr std::size_t maximumBatchSize = 256;

/// One tier of a model. Worker thread; used by one thread at a time; allocates.
class TierGenerator : public SegmentGenerator {
public:
    /// Takes effect with the next batch; without effect on tiers that are not solved. Throws std::invalid_argument for
    /// settings out of range.
    virtual void setSolver(SolverSettings solver);
};

/// Loads, checks and runs a tier of any kind. `runtime` may be null for a tier that needs no ONNX Runtime. The model
/// need not outlive the generator. `native` are the model's, to be shared with its other generators; empty, they are
/// read from the model. `sessions` are those of its other generators on the same thread, or null. Throws
/// std::invalid_argument for solver settings out of range, a batch outside 1 to maximumBatchSize, or a missing runtime;
/// model::ModelError (inconsistent) if a graph or a tensor does not match the format; TierTooSlow; LoadCancelled.
[[nodiscard]] std::unique_ptr<TierGenerator> makeGenerator(std::shared_ptr<const Runtime> runtime,
                                                           const model::ModelFile& model, const model::Tier& tier,
                                                           SolverSettings solver, std::size_t maximumBatch,
                                                           const LoadLimits& limits = {},
                                                           const skeleton::NativeParts& native = {},
                                                           SharedSessions* sessions = nullptr);

/// Loads only what the tier's levels need. Throws the same.
[[nodiscard]] std::unique_ptr<LevelEstimator> makeLevelEstimator(std::shared_ptr<const Runtime> runtime,
                                                                 const model::ModelFile& model, const model::Tier& tier,
                                                                 const LoadLimits& limits = {},
                                                                 const skeleton::NativeParts& native = {});

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
inline constexpr std::size_t skeleton = 0;
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
