#pragma once

#include "inference/onnx_graph.hpp"
#include "inference/shared_sessions.hpp"
#include "inference/solver.hpp"
#include "model/model_file.hpp"

#include <cstddef>
#include <memory>
#include <optional>
#include <span>

namespace haptoflow::inference {

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

}  // namespace haptoflow::inference
