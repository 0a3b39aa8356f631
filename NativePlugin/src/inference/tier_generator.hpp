#pragma once

#include "inference/graph_session.hpp"
#include "inference/load_limits.hpp"
#include "inference/onnx_runtime.hpp"
#include "inference/segment_generator.hpp"
#include "model/model_file.hpp"
#include "skeleton/skeleton_tensors.hpp"

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace haptoflow::inference {

inline constexpr std::size_t maximumBatchSize = 256;

/// One tier of a model. Worker thread; used by one thread at a time; allocates.
class TierGenerator : public SegmentGenerator {
public:
    /// Takes effect with the next batch; without effect on tiers that are not solved. Throws std::invalid_argument for
    /// settings out of range.
    virtual void setSolver(SolverSettings solver);

    /// More requests than the maximum batch are split into several batches. Throws std::invalid_argument if the spans
    /// differ in size, InferenceError if a graph fails, for an impossible level or a sample that is not finite.
    void generate(std::span<const SegmentRequest> requests, std::span<float> segments) final;
    void levels(std::span<const SegmentRequest> requests, std::span<float> levelsMps2) final {
        level_->levels(requests, levelsMps2);
    }

protected:
    /// `source` stands in messages for what makes the segments; it must outlive the generator.
    TierGenerator(std::unique_ptr<LevelEstimator> level, std::size_t maximumBatch, const char* source);

    /// Writes the segments of at most the maximum batch, whose levels are `levelsMps2`.
    virtual void generateBatch(std::span<const SegmentRequest> requests, std::span<const float> levelsMps2,
                               std::span<float> segments) = 0;

private:
    std::unique_ptr<LevelEstimator> level_;
    std::size_t maximumBatch_;
    const char* source_;
    std::vector<float> levelsMps2_;
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

/// Solver and number of steps that the model states for the tier.
[[nodiscard]] SolverSettings defaultSolver(const model::Tier& tier) noexcept;

/// Size of a point of the tier's field: 200, or the size of a latent.
[[nodiscard]] std::size_t pointSize(const model::Tier& tier);

// What the generators of all kinds have in common.

/// What the graphs of a tier are loaded from and with. `sessions` may be null.
struct GraphSource {
    std::shared_ptr<const Runtime> runtime;
    const model::ModelFile& model;
    const model::Tier& tier;
    std::size_t maximumBatch = 1;
    LoadLimits limits{};
    SharedSessions* sessions = nullptr;

    /// Checks the operators of the graph in this blob, loads it, compares it with the format's signature and runs it
    /// once with `batch` requests. Throws model::ModelError (inconsistent), whose message begins with tier and graph;
    /// TierTooSlow; LoadCancelled.
    [[nodiscard]] std::shared_ptr<GraphSession> load(const std::string& blob, const GraphSignature& signature,
                                                     std::size_t batch) const;
};

/// Throws std::invalid_argument unless `steps` is 1 to 16.
void checkSolverSettings(const SolverSettings& settings);

/// Returns `batch`. Throws std::invalid_argument outside 1 to maximumBatchSize.
[[nodiscard]] std::size_t requireBatch(std::size_t batch);

/// Throws std::invalid_argument that begins with `what` unless `found` is `expected`.
void requireSize(std::size_t found, std::size_t expected, const char* what);

/// Calls `action(first, count)` for consecutive parts of at most `maximum` elements.
template <typename Action>
void inBatches(std::size_t total, std::size_t maximum, Action action) {
    for (std::size_t first = 0; first < total; first += maximum) {
        action(first, total - first < maximum ? total - first : maximum);
    }
}

/// The motion for which the request's level is estimated.
[[nodiscard]] inline const std::array<float, 3>& levelMotionOf(const SegmentRequest& request) noexcept {
    return request.levelMotion ? *request.levelMotion : request.motion;
}

/// The RMS in m/s^2 of a request without a level of its own. `logLevel` is what `source` ("level graph") returned for
/// it. Throws InferenceError for an impossible level.
[[nodiscard]] float levelOf(const SegmentRequest& request, float logLevel, const char* source);

}  // namespace haptoflow::inference
