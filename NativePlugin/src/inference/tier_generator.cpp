#include "inference/tier_generator.hpp"

#include "inference/onnx_segment_generator.hpp"
#include "inference/skeleton_generator.hpp"
#include "inference/solver.hpp"
#include "skeleton/skeleton.hpp"

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

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

namespace {

const std::vector<std::int64_t> waveformShape{1, static_cast<std::int64_t>(segmentSamples)};
const TensorSignature embedding{"embedding", {static_cast<std::int64_t>(embeddingSize)}};
const TensorSignature motion{"motion", {3}};
const TensorSignature phases{"phases", {static_cast<std::int64_t>(skeleton::Phases{}.size())}};

const std::vector<std::int64_t>& pointShape(const model::Tier& tier) {
    return tier.representation == model::TierRepresentation::latent ? tier.latentShape : waveformShape;
}

OnnxGraph load(std::shared_ptr<const Runtime> runtime, const model::ModelFile& model, const model::Tier& tier,
               const std::string& blob, const GraphSignature& signature, std::size_t maximumBatch,
               const LoadLimits& limits, SharedSessions* sessions = nullptr) {
    const auto loadOwn = [&] {
        return OnnxGraph::loadChecked(std::move(runtime), model.blob(blob),
                                      "tier \"" + tier.name + "\", graph \"" + blob + '"', signature, maximumBatch,
                                      limits);
    };
    return OnnxGraph(sessions != nullptr ? sessions->getOrLoad(blob, signature, maximumBatch, loadOwn) : loadOwn());
}

}  // namespace

std::size_t pointSize(const model::Tier& tier) {
    return TensorSignature{"", pointShape(tier)}.size();
}

OnnxGraph loadField(std::shared_ptr<const Runtime> runtime, const model::ModelFile& model, const model::Tier& tier,
                    std::size_t maximumBatch, const LoadLimits& limits, SharedSessions* sessions) {
    const bool direct = tier.kind == model::TierKind::direct;
    GraphSignature signature{
        {{"noisy", pointShape(tier)}, {"time", {1}}, {"previous", pointShape(tier)}, embedding, motion, phases},
        {direct ? "segment" : "velocity", pointShape(tier)}};
    if (tier.kind == model::TierKind::averageVelocity) {
        signature.inputs.push_back({"interval", {1}});
    }
    return load(std::move(runtime), model, tier, tier.field, signature, maximumBatch, limits, sessions);
}

OnnxGraph loadRefinement(std::shared_ptr<const Runtime> runtime, const model::ModelFile& model, const model::Tier& tier,
                         std::size_t filmSize, std::size_t maximumBatch, const LoadLimits& limits) {
    constexpr auto samples = static_cast<std::int64_t>(segmentSamples);
    constexpr auto channels = static_cast<std::int64_t>(skeleton::Skeleton::networkInputChannels);
    return load(std::move(runtime), model, tier, tier.field,
                {{{"entering", {channels, 1, samples}},
                  {"past", {1, 1, samples}},
                  {"film", {static_cast<std::int64_t>(filmSize)}}},
                 {"correction", waveformShape}},
                maximumBatch, limits);
}

OnnxGraph loadLevel(std::shared_ptr<const Runtime> runtime, const model::ModelFile& model, const model::Tier& tier,
                    std::size_t maximumBatch, const LoadLimits& limits) {
    return load(std::move(runtime), model, tier, tier.level, {{embedding, motion}, {"log_level", {1}}}, maximumBatch,
                limits);
}

OnnxGraph loadEncoder(std::shared_ptr<const Runtime> runtime, const model::ModelFile& model, const model::Tier& tier,
                      std::size_t maximumBatch, const LoadLimits& limits, SharedSessions* sessions) {
    return load(std::move(runtime), model, tier, tier.encoder,
                {{{"waveform", waveformShape}}, {"latent", pointShape(tier)}}, maximumBatch, limits, sessions);
}

OnnxGraph loadDecoder(std::shared_ptr<const Runtime> runtime, const model::ModelFile& model, const model::Tier& tier,
                      std::size_t maximumBatch, const LoadLimits& limits, SharedSessions* sessions) {
    return load(std::move(runtime), model, tier, tier.decoder,
                {{{"latent", pointShape(tier)}}, {"waveform", waveformShape}}, maximumBatch, limits, sessions);
}

SolverSettings defaultSolver(const model::Tier& tier) noexcept {
    return {tier.solver, tier.steps};
}

}  // namespace haptoflow::inference
