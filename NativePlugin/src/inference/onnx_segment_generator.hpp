#pragma once

#include "inference/graph_session.hpp"
#include "inference/load_limits.hpp"
#include "inference/onnx_runtime.hpp"
#include "inference/segment_generator.hpp"
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

/// A tier's level graph, run by ONNX Runtime. Used by one thread at a time; allocates.
class OnnxLevelEstimator final : public LevelEstimator {
public:
    /// Loads, checks and runs the graph. The model need not outlive it. Throws what OnnxGraph's constructor throws.
    OnnxLevelEstimator(std::shared_ptr<const Runtime> runtime, const model::ModelFile& model, const model::Tier& tier,
                       const LoadLimits& limits = {});

    /// Does not run the graph if every request has its own level. Throws InferenceError if the graph fails or returns
    /// an impossible level, std::invalid_argument if the spans differ in size.
    void levels(std::span<const SegmentRequest> requests, std::span<float> levelsMps2) override;

    [[nodiscard]] std::uint64_t runs() const noexcept { return graph_.runs(); }

private:
    void estimate(std::span<const SegmentRequest> requests, std::span<float> levelsMps2);

    OnnxGraph graph_;
};

/// The field graph of a tier with the inputs of one batch: previous waveforms, embeddings, motions, rib phases. For a
/// tier of kind `direct`, `evaluate` returns the generated point instead of a velocity.
class OnnxVelocityField final : public VelocityField {
public:
    /// Throws what OnnxGraph's constructor throws.
    OnnxVelocityField(std::shared_ptr<const Runtime> runtime, const model::ModelFile& model, const model::Tier& tier,
                      std::size_t maximumBatch, const LoadLimits& limits, SharedSessions* sessions = nullptr);

    void setBatch(std::size_t batch);
    /// Inputs of the batch, to be filled before `evaluate`: batch * 64 and batch * 3 numbers.
    [[nodiscard]] std::span<float> embeddings();
    [[nodiscard]] std::span<float> motions();
    /// Phases of a request of the batch.
    void setPhases(std::size_t request, const skeleton::Phases& phases);
    /// Sets the previous waveforms, batch * 200 numbers in unit scale. A latent tier encodes them here, once for all
    /// steps. Throws InferenceError.
    void setPrevious(std::span<const float> waveforms);

    /// Throws InferenceError.
    void evaluate(std::span<const float> point, float time, float interval, std::span<float> velocity) override;

    [[nodiscard]] std::uint64_t fieldRuns() const noexcept { return field_.runs(); }
    [[nodiscard]] std::uint64_t encoderRuns() const noexcept { return encoder_ ? encoder_->runs() : 0; }

private:
    OnnxGraph field_;
    bool takesInterval_;
    std::optional<OnnxGraph> encoder_;
};

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
