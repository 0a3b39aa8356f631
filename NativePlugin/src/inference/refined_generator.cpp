#include "inference/refined_generator.hpp"

#include "inference/generator_checks.hpp"
#include "inference/solver.hpp"
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
                                   const model::Tier& tier, SolverSettings solver, std::size_t maximumBatch,
                                   const LoadLimits& limits)
    : maximumBatch_(requireBatch(maximumBatch)),
      level_(model),
      skeleton_(skeleton::readSkeleton(model)),
      conditioning_(skeleton::readConditioning(model, tier.name)),
      graph_(loadRefinement(std::move(runtime), model, tier, conditioning_.outputs(), maximumBatch, limits)),
      levelsMps2_(maximumBatch) {
    setSolver(solver);
}

void RefinedGenerator::setSolver(SolverSettings solver) {
    checkSolverSettings(solver);
}

void RefinedGenerator::levels(std::span<const SegmentRequest> requests, std::span<float> levelsMps2) {
    level_.levels(requests, levelsMps2);
}

void RefinedGenerator::generate(std::span<const SegmentRequest> requests, std::span<float> segments) {
    requireSize(segments.size(), requests.size() * segmentSamples, "segments need room");
    inBatches(requests.size(), maximumBatch_, [&](std::size_t first, std::size_t count) {
        generateBatch(requests.subspan(first, count), segments.subspan(first * segmentSamples, count * segmentSamples));
    });
}

void RefinedGenerator::generateBatch(std::span<const SegmentRequest> requests, std::span<float> segments) {
    levels(requests, std::span(levelsMps2_).first(requests.size()));
    graph_.setBatch(requests.size());
    const auto entering = graph_.input(refinement_input::entering);
    const auto past = graph_.input(refinement_input::past);
    const auto film = graph_.input(refinement_input::film);
    for (std::size_t row = 0; row < requests.size(); ++row) {
        std::array<float, segmentSamples> previous{};
        const skeleton::Moment moment = momentOf(requests[row], levelsMps2_[row], previous);
        const skeleton::Condition condition = skeleton::conditionOf(moment.embedding, moment.motion);
        skeleton_->enter(moment, condition,
                         std::span<float, enteringSize>(entering.data() + row * enteringSize, enteringSize));
        std::ranges::reverse_copy(previous, past.subspan(row * segmentSamples).begin());
        conditioning_.run(condition, film.subspan(row * conditioning_.outputs(), conditioning_.outputs()));
    }
    graph_.run();
    for (std::size_t index = 0; index < segments.size(); ++index) {
        const std::size_t row = index / segmentSamples;
        const float begun = entering[row * enteringSize + index % segmentSamples];
        segments[index] = (begun + graph_.output()[index]) * levelsMps2_[row];
    }
    requireFinite(segments, "refining graph");
}

}  // namespace haptoflow::inference
