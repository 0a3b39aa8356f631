#pragma once

#include "inference/inference_error.hpp"
#include "inference/load_limits.hpp"
#include "inference/onnx_level_estimator.hpp"
#include "inference/onnx_runtime.hpp"
#include "inference/onnx_velocity_field.hpp"
#include "inference/segment_generator.hpp"
#include "inference/solver.hpp"
#include "model/model_file.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace haptoflow::inference {

inline constexpr std::size_t largestBatch = 256;

/// How often each graph has run; what proves that nothing is computed that nobody asked for.
struct RunCounts {
    std::uint64_t level = 0;
    std::uint64_t field = 0;
    std::uint64_t encoder = 0;
    std::uint64_t decoder = 0;
};

/// One tier of a model behind ONNX Runtime. Requests beyond `maximumBatch` go through in several batches; up to it,
/// every evaluation of the field is one Run for all of them. Worker thread; one user at a time; allocates.
class OnnxSegmentGenerator final : public SegmentGenerator {
public:
    /// Loads, checks and runs the tier's graphs; the model may go afterwards. Throws std::invalid_argument for a tier
    /// that the model does not have, settings out of range or a batch outside 1 to largestBatch, model::ModelError
    /// (inconsistent) where a graph is not what the format says, TierTooSlow, LoadCancelled.
    OnnxSegmentGenerator(std::shared_ptr<const Runtime> runtime, const model::ModelFile& model, std::string_view tier,
                         SolverSettings solver, std::size_t maximumBatch, const LoadLimits& limits = {});

    /// Takes effect with the next batch. Kind `average-velocity` is always stepped by Euler, kind `direct` is evaluated
    /// once whatever the settings say. Throws std::invalid_argument for settings out of range.
    void setSolver(SolverSettings solver);
    [[nodiscard]] SolverSettings solver() const noexcept { return settings_; }

    void generate(std::span<const SegmentRequest> requests, std::span<float> segments) override;
    void levels(std::span<const SegmentRequest> requests, std::span<float> levelsMps2) override;

    /// The field's value in unit scale where the solver would start: at the requests' noise, at `time`. Raw tiers only
    /// (std::invalid_argument otherwise). This is what shows that graph and training agree, before any solver.
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
