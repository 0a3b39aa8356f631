#include "inference/onnx_segment_generator.hpp"

#include "inference/gaussian_noise.hpp"
#include "inference/generator_checks.hpp"
#include "inference/tier_generator.hpp"
#include "skeleton/skeleton_layout.hpp"

#include <algorithm>
#include <bit>
#include <stdexcept>
#include <string>
#include <utility>

namespace haptoflow::inference {

OnnxLevelEstimator::OnnxLevelEstimator(std::shared_ptr<const Runtime> runtime, const model::ModelFile& model,
                                       const model::Tier& tier, const LoadLimits& limits)
    : graph_(loadLevel(std::move(runtime), model, tier, levelBatch, limits)) {}

void OnnxLevelEstimator::levels(std::span<const SegmentRequest> requests, std::span<float> levelsMps2) {
    requireRoomForLevels(requests, levelsMps2);
    for (std::size_t first = 0; first < requests.size(); first += levelBatch) {
        const std::size_t count = std::min(levelBatch, requests.size() - first);
        estimate(requests.subspan(first, count), levelsMps2.subspan(first, count));
    }
}

void OnnxLevelEstimator::estimate(std::span<const SegmentRequest> requests, std::span<float> levelsMps2) {
    if (std::ranges::all_of(requests, [](const SegmentRequest& each) { return each.levelMps2.has_value(); })) {
        std::ranges::transform(requests, levelsMps2.begin(),
                               [](const SegmentRequest& each) { return *each.levelMps2; });
        return;
    }
    graph_.setBatch(requests.size());
    const auto embeddings = graph_.input(level_input::embedding);
    const auto motions = graph_.input(level_input::motion);
    for (std::size_t index = 0; index < requests.size(); ++index) {
        std::ranges::copy(requests[index].embedding, embeddings.subspan(index * embeddingSize).begin());
        std::ranges::copy(levelMotionOf(requests[index]), motions.subspan(index * 3).begin());
    }
    graph_.run();
    for (std::size_t index = 0; index < requests.size(); ++index) {
        const SegmentRequest& request = requests[index];
        levelsMps2[index] =
            request.levelMps2 ? *request.levelMps2 : levelOf(request, graph_.output()[index], "level graph");
    }
}

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

namespace {

const model::Tier& requireTier(const model::ModelFile& model, std::string_view name) {
    const model::Tier* tier = model.findTier(name);
    if (tier != nullptr) {
        return *tier;
    }
    std::string message = "the model has no tier \"" + std::string(name) + "\"; it has";
    for (const model::Tier& each : model.header().tiers) {
        message += " \"" + each.name + '"';
    }
    throw std::invalid_argument(message);
}

/// Key for the noise of a latent point, which has more numbers than a request's noise. It is derived from that noise,
/// so that equal requests give equal segments.
NoiseKey keyOfNoise(std::span<const float> noise) {
    std::uint64_t hash = 0xCBF29CE484222325U;
    for (const float value : noise) {
        hash = (hash ^ std::bit_cast<std::uint32_t>(value)) * 0x100000001B3U;
    }
    return {hash, 0, 0};
}

}  // namespace

OnnxSegmentGenerator::OnnxSegmentGenerator(std::shared_ptr<const Runtime> runtime, const model::ModelFile& model,
                                           std::string_view tier, SolverSettings solver, std::size_t maximumBatch,
                                           const LoadLimits& limits, SharedSessions* sessions)
    : kind_(requireTier(model, tier).kind),
      maximumBatch_(requireBatch(maximumBatch)),
      pointSize_(pointSize(requireTier(model, tier))),
      level_(runtime, model, requireTier(model, tier), limits),
      field_(runtime, model, requireTier(model, tier), maximumBatch, limits, sessions),
      levelsMps2_(maximumBatch),
      previous_(maximumBatch * segmentSamples),
      points_(maximumBatch * pointSize_),
      result_(maximumBatch * pointSize_) {
    const model::Tier& found = requireTier(model, tier);
    if (found.representation == model::TierRepresentation::latent) {
        decoder_.emplace(loadDecoder(std::move(runtime), model, found, maximumBatch, limits, sessions));
    }
    setSolver(solver);
}

void OnnxSegmentGenerator::setSolver(SolverSettings solver) {
    checkSolverSettings(solver);
    settings_ = solver;
}

void OnnxSegmentGenerator::generate(std::span<const SegmentRequest> requests, std::span<float> segments) {
    requireSize(segments.size(), requests.size() * segmentSamples, "segments need room");
    inBatches(requests.size(), maximumBatch_, [&](std::size_t first, std::size_t count) {
        generateBatch(requests.subspan(first, count), segments.subspan(first * segmentSamples, count * segmentSamples));
    });
}

void OnnxSegmentGenerator::levels(std::span<const SegmentRequest> requests, std::span<float> levelsMps2) {
    level_.levels(requests, levelsMps2);
}

void OnnxSegmentGenerator::generateBatch(std::span<const SegmentRequest> requests, std::span<float> segments) {
    prepare(requests);
    const auto points = std::span(points_).first(requests.size() * pointSize_);
    if (kind_ == model::TierKind::direct) {
        const auto result = std::span(result_).first(points.size());
        field_.evaluate(points, 0.0F, 1.0F, result);
        std::ranges::copy(result, points.begin());
    } else {
        const bool average = kind_ == model::TierKind::averageVelocity;
        solver_.integrate(field_, average ? SolverSettings{SolverKind::euler, settings_.steps} : settings_, points);
    }

    std::span<const float> waveforms = points;
    if (decoder_) {
        decoder_->setBatch(requests.size());
        std::ranges::copy(points, decoder_->input(0).begin());
        decoder_->run();
        waveforms = decoder_->output();
    }
    for (std::size_t index = 0; index < segments.size(); ++index) {
        segments[index] = waveforms[index] * levelsMps2_[index / segmentSamples];
    }
    requireFinite(segments, "field graph");
}

void OnnxSegmentGenerator::prepare(std::span<const SegmentRequest> requests) {
    level_.levels(requests, std::span(levelsMps2_).first(requests.size()));
    field_.setBatch(requests.size());
    const auto embeddings = field_.embeddings();
    const auto motions = field_.motions();
    for (std::size_t index = 0; index < requests.size(); ++index) {
        std::ranges::copy(requests[index].embedding, embeddings.subspan(index * embeddingSize).begin());
        std::ranges::copy(requests[index].motion, motions.subspan(index * 3).begin());
    }

    const auto previous = std::span(previous_).first(requests.size() * segmentSamples);
    for (std::size_t row = 0; row < requests.size(); ++row) {
        const std::span<float, segmentSamples> unit(previous.data() + row * segmentSamples, segmentSamples);
        skeleton::toUnitScale(requests[row].previous, levelsMps2_[row], unit);
    }
    field_.setPrevious(previous);

    for (std::size_t index = 0; index < requests.size(); ++index) {
        field_.setPhases(index, requests[index].phases);
        const auto point = std::span(points_).subspan(index * pointSize_, pointSize_);
        if (const std::span<const float> given = requests[index].latentNoise; !given.empty()) {
            requireSize(given.size(), point.size(), "a latent needs noise");
            std::ranges::copy(given, point.begin());
        } else if (point.size() == segmentSamples) {
            std::ranges::copy(requests[index].noise, point.begin());
        } else {
            fillStandardNormal(keyOfNoise(requests[index].noise), point);
        }
    }
}

RunCounts OnnxSegmentGenerator::runCounts() const noexcept {
    return {level_.runs(), field_.fieldRuns(), field_.encoderRuns(), decoder_ ? decoder_->runs() : 0};
}

}  // namespace haptoflow::inference
