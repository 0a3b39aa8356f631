#include "inference/tier_generator.hpp"

#include "inference/onnx_level_estimator.hpp"
#include "inference/onnx_segment_generator.hpp"
#include "inference/refined_generator.hpp"
#include "inference/skeleton_generator.hpp"
#include "inference/solver.hpp"

#include <stdexcept>
#include <string>
#include <utility>

namespace haptoflow::inference {
namespace {

std::shared_ptr<const Runtime> requireRuntime(std::shared_ptr<const Runtime> runtime, const model::Tier& tier) {
    if (runtime == nullptr) {
        throw std::invalid_argument("not an open runtime handle: the tier \"" + tier.name +
                                    "\" needs ONNX Runtime; only tiers of kind `skeleton` do without");
    }
    return runtime;
}

}  // namespace

void TierGenerator::setSolver(SolverSettings solver) {
    checkSolverSettings(solver);
}

std::unique_ptr<TierGenerator> makeGenerator(std::shared_ptr<const Runtime> runtime, const model::ModelFile& model,
                                             const model::Tier& tier, SolverSettings solver, std::size_t maximumBatch,
                                             const LoadLimits& limits, const skeleton::NativeParts& native,
                                             SharedSessions* sessions) {
    checkSolverSettings(solver);
    switch (tier.kind) {
        case model::TierKind::skeleton:
            return std::make_unique<SkeletonGenerator>(skeleton::sharedOrRead(native, model), maximumBatch, limits);
        case model::TierKind::refine:
            return std::make_unique<RefinedGenerator>(requireRuntime(std::move(runtime), tier), model,
                                                      skeleton::sharedOrRead(native, model), tier, maximumBatch,
                                                      limits);
        default:
            return std::make_unique<OnnxSegmentGenerator>(requireRuntime(std::move(runtime), tier), model, tier.name,
                                                          solver, maximumBatch, limits, sessions);
    }
}

std::unique_ptr<LevelEstimator> makeLevelEstimator(std::shared_ptr<const Runtime> runtime,
                                                   const model::ModelFile& model, const model::Tier& tier,
                                                   const LoadLimits& limits, const skeleton::NativeParts& native) {
    if (tier.usesSkeleton()) {
        return std::make_unique<SkeletonLevelEstimator>(skeleton::sharedOrRead(native, model).level);
    }
    return std::make_unique<OnnxLevelEstimator>(requireRuntime(std::move(runtime), tier), model, tier, limits);
}

}  // namespace haptoflow::inference
