#pragma once

#include "inference/load_limits.hpp"
#include "inference/onnx_runtime.hpp"
#include "inference/segment_generator.hpp"
#include "inference/shared_sessions.hpp"
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

}  // namespace haptoflow::inference
