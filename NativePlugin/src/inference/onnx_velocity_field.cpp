#include "inference/onnx_velocity_field.hpp"

#include "inference/tier_graphs.hpp"

#include <algorithm>

namespace haptoflow::inference {

OnnxVelocityField::OnnxVelocityField(std::shared_ptr<const Runtime> runtime, const model::ModelFile& model,
                                     const model::Tier& tier, std::size_t maximumBatch, const LoadLimits& limits,
                                     SharedSessions* sessions)
    : field_(loadField(runtime, model, tier, maximumBatch, limits, sessions)),
      takesInterval_(tier.kind == model::TierKind::averageVelocity) {
    if (tier.representation == model::TierRepresentation::latent && field_.hasInput(field_input::previous)) {
        encoder_.emplace(loadEncoder(runtime, model, tier, maximumBatch, limits, sessions));
    }
}

void OnnxVelocityField::setBatch(std::size_t batch) {
    field_.setBatch(batch);
    if (encoder_) {
        encoder_->setBatch(batch);
    }
}

std::span<float> OnnxVelocityField::embeddings() {
    return field_.input(field_input::embedding);
}

std::span<float> OnnxVelocityField::motions() {
    return field_.input(field_input::motion);
}

void OnnxVelocityField::setPhases(std::size_t request, const skeleton::Phases& phases) {
    std::ranges::copy(phases, field_.input(field_input::phases).subspan(request * phases.size()).begin());
}

void OnnxVelocityField::setPrevious(std::span<const float> waveforms) {
    if (encoder_) {
        std::ranges::copy(waveforms, encoder_->input(0).begin());
        encoder_->run();
        std::ranges::copy(encoder_->output(), field_.input(field_input::previous).begin());
    } else if (field_.hasInput(field_input::previous)) {
        std::ranges::copy(waveforms, field_.input(field_input::previous).begin());
    }
}

void OnnxVelocityField::evaluate(std::span<const float> point, float time, float interval, std::span<float> velocity) {
    std::ranges::copy(point, field_.input(field_input::noisy).begin());
    std::ranges::fill(field_.input(field_input::time), time);
    if (takesInterval_) {
        std::ranges::fill(field_.input(field_input::interval), interval);
    }
    field_.run();
    std::ranges::copy(field_.output(), velocity.begin());
}

}  // namespace haptoflow::inference
