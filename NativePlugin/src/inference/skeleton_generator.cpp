#include "inference/skeleton_generator.hpp"

#include "inference/generator_checks.hpp"
#include "inference/level_rules.hpp"
#include "skeleton/condition.hpp"
#include "skeleton/unit_scale.hpp"

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

}  // namespace haptoflow::inference
