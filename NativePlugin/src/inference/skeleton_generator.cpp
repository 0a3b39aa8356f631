#include "inference/skeleton_generator.hpp"

#include "inference/generator_checks.hpp"
#include "inference/tier_generator.hpp"
#include "skeleton/condition.hpp"
#include "skeleton/skeleton_layout.hpp"
#include "skeleton/skeleton_tensors.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace haptoflow::inference {

SkeletonLevelEstimator::SkeletonLevelEstimator(std::shared_ptr<const skeleton::LevelModel> level)
    : level_(std::move(level)) {}

void SkeletonLevelEstimator::levels(std::span<const SegmentRequest> requests, std::span<float> levelsMps2) {
    requireRoomForLevels(requests, levelsMps2);
    std::ranges::transform(requests, levelsMps2.begin(), [this](const SegmentRequest& request) {
        return request.levelMps2
                   ? *request.levelMps2
                   : levelOf(request, level_->logLevel(request.embedding, levelMotionOf(request)), "level model");
    });
}

skeleton::Moment momentOf(const SegmentRequest& request, float levelMps2,
                          std::span<float, segmentSamples> previous) noexcept {
    skeleton::toUnitScale(request.previous, levelMps2, previous);
    return {.embedding = request.embedding,
            .motion = request.motion,
            .phases = request.phases,
            .previous = previous,
            .noise = request.noise,
            .impulseGain = request.impulseGain};
}

SkeletonGenerator::SkeletonGenerator(skeleton::NativeParts native, std::size_t maximumBatch, const LoadLimits& limits)
    : level_(std::move(native.level)), skeleton_(std::move(native.skeleton)), levelsMps2_(requireBatch(maximumBatch)) {
    limits.check();
}

void SkeletonGenerator::levels(std::span<const SegmentRequest> requests, std::span<float> levelsMps2) {
    level_.levels(requests, levelsMps2);
}

void SkeletonGenerator::generate(std::span<const SegmentRequest> requests, std::span<float> segments) {
    requireSize(segments.size(), requests.size() * segmentSamples, "segments need room");
    levelsMps2_.resize(std::max(levelsMps2_.size(), requests.size()));
    const auto levelsMps2 = std::span(levelsMps2_).first(requests.size());
    levels(requests, levelsMps2);
    for (std::size_t row = 0; row < requests.size(); ++row) {
        const std::span<float, segmentSamples> segment(segments.data() + row * segmentSamples, segmentSamples);
        std::array<float, segmentSamples> previous{};
        const skeleton::Moment moment = momentOf(requests[row], levelsMps2[row], previous);
        skeleton_->sketch(moment, skeleton::conditionOf(moment.embedding, moment.motion, moment.phases), segment);
        std::ranges::for_each(segment, [level = levelsMps2[row]](float& sample) { sample *= level; });
    }
    requireFinite(segments, "skeleton");
}

void SkeletonGenerator::generateFromSketches(std::span<const SegmentRequest> requests, std::span<float> segments,
                                             const Sketched& sketched) {
    generate(requests, segments);
    sketched(0, segments);
}

namespace {

constexpr std::size_t networkInputSize = skeleton::Skeleton::networkInputChannels * segmentSamples;

}  // namespace

RefinedGenerator::RefinedGenerator(std::shared_ptr<const Runtime> runtime, const model::ModelFile& model,
                                   skeleton::NativeParts native, const model::Tier& tier, std::size_t maximumBatch,
                                   const LoadLimits& limits)
    : maximumBatch_(requireBatch(maximumBatch)),
      level_(std::move(native.level)),
      skeleton_(std::move(native.skeleton)),
      conditioning_(skeleton::readConditioning(model, tier.name)),
      graph_(loadRefinement(std::move(runtime), model, tier, conditioning_.outputs(), maximumBatch, limits)),
      levelsMps2_(maximumBatch) {}

void RefinedGenerator::levels(std::span<const SegmentRequest> requests, std::span<float> levelsMps2) {
    level_.levels(requests, levelsMps2);
}

void RefinedGenerator::generate(std::span<const SegmentRequest> requests, std::span<float> segments) {
    generateFromSketches(requests, segments, [](std::size_t, std::span<const float>) {});
}

void RefinedGenerator::generateFromSketches(std::span<const SegmentRequest> requests, std::span<float> segments,
                                            const Sketched& sketched) {
    requireSize(segments.size(), requests.size() * segmentSamples, "segments need room");
    inBatches(requests.size(), maximumBatch_, [&](std::size_t first, std::size_t count) {
        const auto batch = segments.subspan(first * segmentSamples, count * segmentSamples);
        sketchBatch(requests.subspan(first, count), batch);
        sketched(first, batch);
        refineBatch(batch);
    });
}

void RefinedGenerator::sketchBatch(std::span<const SegmentRequest> requests, std::span<float> segments) {
    levels(requests, std::span(levelsMps2_).first(requests.size()));
    graph_.setBatch(requests.size());
    const auto networkInput = graph_.input(refinement_input::skeleton);
    const auto past = graph_.input(refinement_input::past);
    const auto film = graph_.input(refinement_input::film);
    for (std::size_t row = 0; row < requests.size(); ++row) {
        std::array<float, segmentSamples> previous{};
        const skeleton::Moment moment = momentOf(requests[row], levelsMps2_[row], previous);
        const skeleton::Condition condition = skeleton::conditionOf(moment.embedding, moment.motion, moment.phases);
        const std::span<float, networkInputSize> seen(networkInput.data() + row * networkInputSize, networkInputSize);
        skeleton_->enter(moment, condition, seen);
        std::ranges::transform(seen.first<segmentSamples>(), segments.subspan(row * segmentSamples).begin(),
                               [level = levelsMps2_[row]](float sample) { return sample * level; });
        std::ranges::reverse_copy(previous, past.subspan(row * segmentSamples).begin());
        conditioning_.run(condition, film.subspan(row * conditioning_.outputs(), conditioning_.outputs()));
    }
    requireFinite(segments, "skeleton");
}

void RefinedGenerator::refineBatch(std::span<float> segments) {
    graph_.run();
    for (std::size_t index = 0; index < segments.size(); ++index) {
        segments[index] += graph_.output()[index] * levelsMps2_[index / segmentSamples];
    }
    requireFinite(segments, "refining graph");
}

}  // namespace haptoflow::inference
