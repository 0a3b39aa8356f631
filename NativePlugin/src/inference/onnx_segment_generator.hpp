#pragma once

#include "inference/graph_session.hpp"
#include "inference/segment_generator.hpp"
#include "inference/tier_generator.hpp"

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace haptoflow::inference {

/// A velocity field u(x, t) for a point x in unit scale and a time t from 0 to 1. A batch is treated as one long point.
/// Writes u(point, time) into `velocity`, which has the size of `point` and does not overlap it. `interval` is the
/// length of the solver's step; only average-velocity fields read it.
using VelocityField =
    std::function<void(std::span<const float> point, float time, float interval, std::span<float> velocity)>;

/// Explicit one-step solvers with equal steps. Used by one thread at a time; allocates if the point is larger than any
/// before.
class Solver {
public:
    /// Integrates `field` from time 0 to time 1, starting at `point`, and writes the result to `point`. Throws what the
    /// field throws, and std::invalid_argument for settings out of range.
    void integrate(const VelocityField& field, const SolverSettings& settings, std::span<float> point);

private:
    std::vector<float> velocity_;
    std::vector<float> trialPoint_;
    std::vector<float> trialVelocity_;
};

/// A tier's level graph, run by ONNX Runtime. Used by one thread at a time; allocates.
class OnnxLevelEstimator final : public LevelEstimator {
public:
    /// Loads, checks and runs the graph. The model need not outlive it. Throws what GraphSource::load throws.
    explicit OnnxLevelEstimator(const GraphSource& source);

    /// Does not run the graph if every request has its own level. Throws InferenceError if the graph fails or returns
    /// an impossible level, std::invalid_argument if the spans differ in size.
    void levels(std::span<const SegmentRequest> requests, std::span<float> levelsMps2) override;

private:
    void estimate(std::span<const SegmentRequest> requests, std::span<float> levelsMps2);

    std::shared_ptr<GraphSession> graph_;
};

/// A tier that is a network alone, run by ONNX Runtime, with one run of the field for each evaluation of a batch.
class OnnxSegmentGenerator final : public TierGenerator {
public:
    /// Loads, checks and runs the tier's graphs. The model need not outlive the generator. Throws std::invalid_argument
    /// for solver settings out of range, and what GraphSource::load throws.
    OnnxSegmentGenerator(const GraphSource& source, SolverSettings solver);

    /// Takes effect with the next batch. Tiers of kind `average-velocity` always use Euler steps; tiers of kind
    /// `direct` are evaluated once and ignore the settings. Throws std::invalid_argument for settings out of range.
    void setSolver(SolverSettings solver) override;

private:
    void generateBatch(std::span<const SegmentRequest> requests, std::span<const float> levelsMps2,
                       std::span<float> segments) override;
    /// Fills the inputs that stay the same for all steps, and the points from which the solver starts.
    void prepare(std::span<const SegmentRequest> requests, std::span<const float> levelsMps2);
    /// The field at a time, or for a tier of kind `direct` the generated point itself.
    void evaluate(std::span<const float> point, float time, float interval, std::span<float> velocity);

    model::TierKind kind_;
    SolverSettings settings_;
    std::size_t pointSize_;
    std::shared_ptr<GraphSession> field_;
    /// Null unless the tier is latent, the encoder also if the field does not see the previous waveform.
    std::shared_ptr<GraphSession> encoder_;
    std::shared_ptr<GraphSession> decoder_;
    Solver solver_;
    std::vector<float> previous_;
    std::vector<float> points_;
    std::vector<float> result_;
};

}  // namespace haptoflow::inference
