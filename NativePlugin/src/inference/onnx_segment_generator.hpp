#pragma once

#include "inference/inference_error.hpp"
#include "inference/load_limits.hpp"
#include "inference/onnx_level_estimator.hpp"
#include "inference/onnx_runtime.hpp"
#include "inference/onnx_velocity_field.hpp"
#include "inference/segment_generator.hpp"
#include "inference/shared_sessions.hpp"
#include "inference/solver.hpp"
#include "inference/tier_generator.hpp"
#include "model/model_file.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace haptoflow::inference {

/// Number of runs of each graph. Tests use it to show that nothing is computed needlessly.
struct RunCounts {
    std::uint64_t level = 0;
    std::uint64_t field = 0;
    std::uint64_t encoder = 0;
    std::uint64_t decoder = 0;
};

/// A tier that is a network alone, run by ONNX Runtime. Up to `maximumBatch` requests are evaluated together, with one
/// run per evaluation of the field; more requests are split into several batches. Worker thread; used by one thread at
/// a time; allocates.
class OnnxSegmentGenerator final : public TierGenerator {
public:
    /// Loads, checks and runs the tier's graphs, or takes them from `sessions`, which may be null. The model need not
    /// outlive the generator. Throws std::invalid_argument
    /// for a tier that the model does not have, solver settings out of range or a batch outside 1 to maximumBatchSize;
    /// model::ModelError (inconsistent) if a graph does not match the format; TierTooSlow; LoadCancelled.
    OnnxSegmentGenerator(std::shared_ptr<const Runtime> runtime, const model::ModelFile& model, std::string_view tier,
                         SolverSettings solver, std::size_t maximumBatch, const LoadLimits& limits = {},
                         SharedSessions* sessions = nullptr);

    /// Takes effect with the next batch. Tiers of kind `average-velocity` always use Euler steps; tiers of kind
    /// `direct` are evaluated once and ignore the settings. Throws std::invalid_argument for settings out of range.
    void setSolver(SolverSettings solver) override;
    [[nodiscard]] SolverSettings solver() const noexcept { return settings_; }

    void generate(std::span<const SegmentRequest> requests, std::span<float> segments) override;
    void levels(std::span<const SegmentRequest> requests, std::span<float> levelsMps2) override;

    /// The field's value in unit scale at the solver's starting point, the requests' noise, and at `time`. Tests use it
    /// to compare the graph with training, without a solver. Throws std::invalid_argument for a latent tier.
    void evaluateField(std::span<const SegmentRequest> requests, float time, float interval,
                       std::span<float> velocities);

    [[nodiscard]] RunCounts runCounts() const noexcept;

private:
    void generateBatch(std::span<const SegmentRequest> requests, std::span<float> segments);
    void prepare(std::span<const SegmentRequest> requests);

    model::TierKind kind_;
    SolverSettings settings_;
    std::size_t maximumBatch_;
    std::size_t pointSize_;
    OnnxLevelEstimator level_;
    OnnxVelocityField field_;
    std::optional<OnnxGraph> decoder_;
    Solver solver_;
    std::vector<float> levelsMps2_;
    std::vector<float> previous_;
    std::vector<float> points_;
    std::vector<float> result_;
};

}  // namespace haptoflow::inference
