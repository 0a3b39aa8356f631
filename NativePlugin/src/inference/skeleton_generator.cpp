#include "inference/skeleton_generator.hpp"

#include "skeleton/condition.hpp"
#include "skeleton/skeleton_layout.hpp"
#include "skeleton/synthesis.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace haptoflow::inference {

SkeletonLevelEstimator::SkeletonLevelEstimator(std::shared_ptr<const skeleton::LevelModel> level)
    : level_(std::move(level)) {}

void SkeletonLevelEstimator::levels(std::span<const SegmentRequest> requests, std::span<float> levelsMps2) {
    requireSize(levelsMps2.size(), requests.size(), "levels need room");
    std::ranges::transform(requests, levelsMps2.begin(), [this](const SegmentRequest& request) {
        return request.levelMps2
                   ? *request.levelMps2
                   : levelOf(request, level_->logLevel(request.embedding, levelMotionOf(request)), "level model");
    });
}

namespace {

/// Of the skeleton alone, in unit scale.
std::array<float, segmentSamples> ownUnitOf(const SegmentRequest& request, float levelMps2) {
    std::array<float, segmentSamples> unit{};
    if (request.own.empty()) {
        skeleton::toUnitScale(request.previous, levelMps2, unit);
    } else {
        requireSize(request.own.size(), segmentSamples, "the skeleton's own past needs room");
        skeleton::toUnitScale(request.own.first<segmentSamples>(), levelMps2, unit);
    }
    return unit;
}

skeleton::Condition conditionOf(const SegmentRequest& request) noexcept {
    return skeleton::conditionOf(request.embedding, request.motion, request.phases);
}

/// What a stream has made of the request, or else what the request alone makes.
/// `made` holds what is made.
const skeleton::NetworkInput& networkInputOf(const SegmentRequest& request, float levelMps2,
                                             const skeleton::Skeleton& skeleton, skeleton::NetworkInput& made) {
    if (request.networkInput != nullptr) {
        return *request.networkInput;
    }
    std::array<double, skeleton::familyCount> ratesHz{};
    std::ranges::copy(std::span(request.phases).last<skeleton::familyCount>(), ratesHz.begin());
    const auto ownUnit = ownUnitOf(request, levelMps2);
    made = synthesiseSegment(skeleton, skeleton.parametersFor(conditionOf(request), ratesHz, request.impulseGain),
                             {.phases = request.phases, .previous = ownUnit, .noise = request.noise});
    return made;
}

/// Positions of the inputs in the graph's signature.
namespace refinement_input {
constexpr std::size_t skeleton = 0, past = 1, own = 2, film = 3;
}  // namespace refinement_input

/// `filmSize` numbers condition the graph.
GraphSignature refinementSignature(std::size_t filmSize) {
    constexpr auto samples = static_cast<std::int64_t>(segmentSamples);
    constexpr auto channels = static_cast<std::int64_t>(skeleton::NetworkInput::channels);
    return {{{"entering", {channels, 1, samples}},
             {"past", {1, 1, samples}},
             {"own", {1, 1, samples}},
             {"film", {static_cast<std::int64_t>(filmSize)}}},
            {"correction", {1, samples}}};
}

}  // namespace

SkeletonGenerator::SkeletonGenerator(skeleton::NativeParts native, std::size_t maximumBatch, const LoadLimits& limits)
    : TierGenerator(std::make_unique<SkeletonLevelEstimator>(std::move(native.level)), maximumBatch, "skeleton"),
      skeleton_(std::move(native.skeleton)) {
    limits.check();
}

void SkeletonGenerator::generateBatch(std::span<const SegmentRequest> requests, std::span<const float> levelsMps2,
                                      std::span<float> segments) {
    skeleton::NetworkInput made;
    for (std::size_t row = 0; row < requests.size(); ++row) {
        const skeleton::NetworkInput& input = networkInputOf(requests[row], levelsMps2[row], *skeleton_, made);
        std::ranges::transform(input.segment(), segments.subspan(row * segmentSamples).begin(),
                               [level = levelsMps2[row]](float sample) { return sample * level; });
    }
}

RefinedGenerator::RefinedGenerator(const GraphSource& source, skeleton::NativeParts native)
    : TierGenerator(std::make_unique<SkeletonLevelEstimator>(std::move(native.level)), source.maximumBatch,
                    "refining graph"),
      skeleton_(std::move(native.skeleton)),
      conditioning_(skeleton::readConditioning(source.model, source.tier.name)),
      graph_(source.load(source.tier.field, refinementSignature(conditioning_.outputs()), source.maximumBatch)) {}

void RefinedGenerator::generateBatch(std::span<const SegmentRequest> requests, std::span<const float> levelsMps2,
                                     std::span<float> segments) {
    graph_->setBatch(requests.size());
    const auto seen = graph_->input(refinement_input::skeleton);
    const auto past = graph_->input(refinement_input::past);
    const auto own = graph_->input(refinement_input::own);
    const auto film = graph_->input(refinement_input::film);
    skeleton::NetworkInput made;
    for (std::size_t row = 0; row < requests.size(); ++row) {
        std::array<float, segmentSamples> previous{};
        skeleton::toUnitScale(requests[row].previous, levelsMps2[row], previous);
        const auto ownUnit = ownUnitOf(requests[row], levelsMps2[row]);
        const skeleton::NetworkInput& input = networkInputOf(requests[row], levelsMps2[row], *skeleton_, made);
        std::ranges::copy(input.values, seen.subspan(row * input.values.size()).begin());
        std::ranges::reverse_copy(previous, past.subspan(row * segmentSamples).begin());
        std::ranges::reverse_copy(ownUnit, own.subspan(row * segmentSamples).begin());
        conditioning_.run(conditionOf(requests[row]),
                          film.subspan(row * conditioning_.outputs(), conditioning_.outputs()));
        std::ranges::copy(input.segment(), segments.subspan(row * segmentSamples).begin());
    }
    graph_->run();
    for (std::size_t index = 0; index < segments.size(); ++index) {
        segments[index] = (segments[index] + graph_->output()[index]) * levelsMps2[index / segmentSamples];
    }
}

}  // namespace haptoflow::inference
