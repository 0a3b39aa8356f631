#include "inference/onnx_segment_generator.hpp"

#include "skeleton/gaussian_noise.hpp"
#include "skeleton/skeleton_layout.hpp"

#include <algorithm>
#include <bit>

namespace haptoflow::inference {
namespace {

/// result = point + factor * direction, element by element.
void advance(std::span<const float> point, float factor, std::span<const float> direction, std::span<float> result) {
    for (std::size_t index = 0; index < result.size(); ++index) {
        result[index] = point[index] + factor * direction[index];
    }
}

/// Positions of the inputs in the signatures of the graphs. Only tiers of kind `average-velocity` have the interval.
namespace field_input {
constexpr std::size_t noisy = 0, time = 1, previous = 2, embedding = 3, motion = 4, phases = 5, interval = 6;
}  // namespace field_input
namespace level_input {
constexpr std::size_t embedding = 0, motion = 1;
}  // namespace level_input

const std::vector<std::int64_t> waveformShape{1, static_cast<std::int64_t>(segmentSamples)};
const TensorSignature embedding{"embedding", {static_cast<std::int64_t>(embeddingSize)}};
const TensorSignature motion{"motion", {3}};
const TensorSignature phases{"phases", {static_cast<std::int64_t>(skeleton::Phases{}.size())}};

const std::vector<std::int64_t>& pointShape(const model::Tier& tier) {
    return tier.representation == model::TierRepresentation::latent ? tier.latentShape : waveformShape;
}

GraphSignature fieldSignature(const model::Tier& tier) {
    const auto& point = pointShape(tier);
    GraphSignature signature{{{"noisy", point}, {"time", {1}}, {"previous", point}, embedding, motion, phases},
                             {tier.kind == model::TierKind::direct ? "segment" : "velocity", point}};
    if (tier.kind == model::TierKind::averageVelocity) {
        signature.inputs.push_back({"interval", {1}});
    }
    return signature;
}

GraphSource withoutSessions(GraphSource source) {
    source.sessions = nullptr;
    return source;
}

/// Key for the noise of a latent point, which has more numbers than a request's noise. It is derived from that noise,
/// so that equal requests give equal segments.
skeleton::NoiseKey keyOfNoise(std::span<const float> noise) {
    std::uint64_t hash = 0xCBF29CE484222325U;
    for (const float value : noise) {
        hash = (hash ^ std::bit_cast<std::uint32_t>(value)) * 0x100000001B3U;
    }
    return {hash, 0, 0};
}

/// Copies one request's numbers into its row of an input.
template <typename Numbers>
void fillRow(std::span<float> input, std::size_t row, const Numbers& numbers) {
    std::ranges::copy(numbers, input.subspan(row * numbers.size()).begin());
}

}  // namespace

void Solver::integrate(const VelocityField& field, const SolverSettings& settings, std::span<float> point) {
    checkSolverSettings(settings);
    velocity_.resize(point.size());
    trialPoint_.resize(point.size());
    trialVelocity_.resize(point.size());

    const double stepCount = settings.steps;
    const auto step = static_cast<float>(1.0 / stepCount);
    for (int index = 0; index < settings.steps; ++index) {
        const auto start = static_cast<float>(index / stepCount);
        const auto middle = static_cast<float>((index + 0.5) / stepCount);
        const auto end = static_cast<float>((index + 1) / stepCount);
        field(point, start, step, velocity_);
        switch (settings.kind) {
            case SolverKind::euler:
                advance(point, step, velocity_, point);
                break;
            case SolverKind::midpoint:
                advance(point, 0.5F * step, velocity_, trialPoint_);
                field(trialPoint_, middle, step, trialVelocity_);
                advance(point, step, trialVelocity_, point);
                break;
            case SolverKind::heun:
                advance(point, step, velocity_, trialPoint_);
                field(trialPoint_, end, step, trialVelocity_);
                advance(point, 0.5F * step, velocity_, point);
                advance(point, 0.5F * step, trialVelocity_, point);
                break;
        }
    }
}

std::size_t pointSize(const model::Tier& tier) {
    return TensorSignature{"", pointShape(tier)}.size();
}

OnnxLevelEstimator::OnnxLevelEstimator(const GraphSource& source)
    : graph_(source.load(source.tier.level, {{embedding, motion}, {"log_level", {1}}}, levelBatch)) {}

void OnnxLevelEstimator::levels(std::span<const SegmentRequest> requests, std::span<float> levelsMps2) {
    requireSize(levelsMps2.size(), requests.size(), "levels need room");
    inBatches(requests.size(), levelBatch, [&](std::size_t first, std::size_t count) {
        estimate(requests.subspan(first, count), levelsMps2.subspan(first, count));
    });
}

void OnnxLevelEstimator::estimate(std::span<const SegmentRequest> requests, std::span<float> levelsMps2) {
    if (!std::ranges::all_of(requests, [](const SegmentRequest& each) { return each.levelMps2.has_value(); })) {
        graph_->setBatch(requests.size());
        for (std::size_t row = 0; row < requests.size(); ++row) {
            fillRow(graph_->input(level_input::embedding), row, requests[row].embedding);
            fillRow(graph_->input(level_input::motion), row, levelMotionOf(requests[row]));
        }
        graph_->run();
    }
    for (std::size_t row = 0; row < requests.size(); ++row) {
        const SegmentRequest& request = requests[row];
        levelsMps2[row] =
            request.levelMps2 ? *request.levelMps2 : levelOf(request, graph_->output()[row], "level graph");
    }
}

OnnxSegmentGenerator::OnnxSegmentGenerator(const GraphSource& source, SolverSettings solver)
    : TierGenerator(std::make_unique<OnnxLevelEstimator>(withoutSessions(source)), source.maximumBatch, "field graph"),
      kind_(source.tier.kind),
      pointSize_(pointSize(source.tier)),
      field_(source.load(source.tier.field, fieldSignature(source.tier), source.maximumBatch)),
      previous_(source.maximumBatch * segmentSamples),
      points_(source.maximumBatch * pointSize_),
      result_(source.maximumBatch * pointSize_) {
    if (source.tier.representation == model::TierRepresentation::latent) {
        const TensorSignature waveform{"waveform", waveformShape};
        const TensorSignature latent{"latent", pointShape(source.tier)};
        if (field_->hasInput(field_input::previous)) {
            encoder_ = source.load(source.tier.encoder, {{waveform}, latent}, source.maximumBatch);
        }
        decoder_ = source.load(source.tier.decoder, {{latent}, waveform}, source.maximumBatch);
    }
    setSolver(solver);
}

void OnnxSegmentGenerator::setSolver(SolverSettings solver) {
    checkSolverSettings(solver);
    settings_ = solver;
}

void OnnxSegmentGenerator::evaluate(std::span<const float> point, float time, float interval,
                                    std::span<float> velocity) {
    std::ranges::copy(point, field_->input(field_input::noisy).begin());
    std::ranges::fill(field_->input(field_input::time), time);
    if (kind_ == model::TierKind::averageVelocity) {
        std::ranges::fill(field_->input(field_input::interval), interval);
    }
    field_->run();
    std::ranges::copy(field_->output(), velocity.begin());
}

void OnnxSegmentGenerator::generateBatch(std::span<const SegmentRequest> requests, std::span<const float> levelsMps2,
                                         std::span<float> segments) {
    prepare(requests, levelsMps2);
    const auto points = std::span(points_).first(requests.size() * pointSize_);
    if (kind_ == model::TierKind::direct) {
        const auto result = std::span(result_).first(points.size());
        evaluate(points, 0.0F, 1.0F, result);
        std::ranges::copy(result, points.begin());
    } else {
        const bool average = kind_ == model::TierKind::averageVelocity;
        solver_.integrate([this](auto... arguments) { evaluate(arguments...); },
                          average ? SolverSettings{SolverKind::euler, settings_.steps} : settings_, points);
    }

    std::span<const float> waveforms = points;
    if (decoder_) {
        decoder_->setBatch(requests.size());
        std::ranges::copy(points, decoder_->input(0).begin());
        decoder_->run();
        waveforms = decoder_->output();
    }
    for (std::size_t index = 0; index < segments.size(); ++index) {
        segments[index] = waveforms[index] * levelsMps2[index / segmentSamples];
    }
}

void OnnxSegmentGenerator::prepare(std::span<const SegmentRequest> requests, std::span<const float> levelsMps2) {
    field_->setBatch(requests.size());
    const auto previous = std::span(previous_).first(requests.size() * segmentSamples);
    for (std::size_t row = 0; row < requests.size(); ++row) {
        const SegmentRequest& request = requests[row];
        fillRow(field_->input(field_input::embedding), row, request.embedding);
        fillRow(field_->input(field_input::motion), row, request.motion);
        fillRow(field_->input(field_input::phases), row, request.phases);
        skeleton::toUnitScale(request.previous, levelsMps2[row],
                              previous.subspan(row * segmentSamples).first<segmentSamples>());
        const auto point = std::span(points_).subspan(row * pointSize_, pointSize_);
        if (!request.latentNoise.empty()) {
            requireSize(request.latentNoise.size(), point.size(), "a latent needs noise");
            std::ranges::copy(request.latentNoise, point.begin());
        } else if (point.size() == segmentSamples) {
            std::ranges::copy(request.noise, point.begin());
        } else {
            skeleton::fillStandardNormal(keyOfNoise(request.noise), point);
        }
    }
    if (encoder_) {
        encoder_->setBatch(requests.size());
        std::ranges::copy(previous, encoder_->input(0).begin());
        encoder_->run();
        std::ranges::copy(encoder_->output(), field_->input(field_input::previous).begin());
    } else if (field_->hasInput(field_input::previous)) {
        std::ranges::copy(previous, field_->input(field_input::previous).begin());
    }
}

}  // namespace haptoflow::inference
