#include "inference/refined_generator.hpp"

#include "inference/generator_checks.hpp"
#include "inference/tier_graphs.hpp"
#include "skeleton/condition.hpp"
#include "skeleton/skeleton_tensors.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace haptoflow::inference {
namespace {

constexpr std::size_t enteringSize = skeleton::Skeleton::enteringChannels * segmentSamples;

}  // namespace

RefinedGenerator::RefinedGenerator(std::shared_ptr<const Runtime> runtime, const model::ModelFile& model,
                                   skeleton::NativeParts native, const model::Tier& tier,
                                   std::size_t maximumBatch, const LoadLimits& limits)
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
    const auto entering = graph_.input(refinement_input::entering);
    const auto past = graph_.input(refinement_input::past);
    const auto film = graph_.input(refinement_input::film);
    for (std::size_t row = 0; row < requests.size(); ++row) {
        std::array<float, segmentSamples> previous{};
        const skeleton::Moment moment = momentOf(requests[row], levelsMps2_[row], previous);
        const skeleton::Condition condition = skeleton::conditionOf(moment.embedding, moment.motion, moment.phases);
        const std::span<float, enteringSize> seen(entering.data() + row * enteringSize, enteringSize);
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
