#include "inference/tier_generator.hpp"

#include "inference/onnx_segment_generator.hpp"
#include "inference/skeleton_generator.hpp"
#include "model/onnx_check.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace haptoflow::inference {
namespace {

constexpr int maximumSolverSteps = 16;

std::shared_ptr<const Runtime> requireRuntime(std::shared_ptr<const Runtime> runtime, const model::Tier& tier) {
    if (runtime == nullptr) {
        throw std::invalid_argument("not an open runtime handle: the tier \"" + tier.name +
                                    "\" needs ONNX Runtime; only tiers of kind `skeleton` do without");
    }
    return runtime;
}

}  // namespace

TierGenerator::TierGenerator(std::unique_ptr<LevelEstimator> level, std::size_t maximumBatch, const char* source)
    : level_(std::move(level)), maximumBatch_(maximumBatch), source_(source), levelsMps2_(maximumBatch) {}

void TierGenerator::setSolver(SolverSettings solver) {
    checkSolverSettings(solver);
}

void TierGenerator::generate(std::span<const SegmentRequest> requests, std::span<float> segments) {
    requireSize(segments.size(), requests.size() * segmentSamples, "segments need room");
    inBatches(requests.size(), maximumBatch_, [&](std::size_t first, std::size_t count) {
        const auto batch = requests.subspan(first, count);
        const auto levelsMps2 = std::span(levelsMps2_).first(count);
        const auto made = segments.subspan(first * segmentSamples, count * segmentSamples);
        levels(batch, levelsMps2);
        generateBatch(batch, levelsMps2, made);
        if (!std::ranges::all_of(made, [](float sample) { return std::isfinite(sample); })) {
            throw InferenceError(std::string("the ") + source_ + " returned a waveform that is not finite");
        }
    });
}

std::unique_ptr<TierGenerator> makeGenerator(std::shared_ptr<const Runtime> runtime, const model::ModelFile& model,
                                             const model::Tier& tier, SolverSettings solver, std::size_t maximumBatch,
                                             const LoadLimits& limits, const skeleton::NativeParts& native,
                                             SharedSessions* sessions) {
    checkSolverSettings(solver);
    const std::size_t batch = requireBatch(maximumBatch);
    if (tier.kind == model::TierKind::skeleton) {
        return std::make_unique<SkeletonGenerator>(skeleton::sharedOrRead(native, model), batch, limits);
    }
    const GraphSource source{requireRuntime(std::move(runtime), tier), model, tier, batch, limits, sessions};
    if (tier.kind == model::TierKind::refine) {
        return std::make_unique<RefinedGenerator>(source, skeleton::sharedOrRead(native, model));
    }
    return std::make_unique<OnnxSegmentGenerator>(source, solver);
}

std::unique_ptr<LevelEstimator> makeLevelEstimator(std::shared_ptr<const Runtime> runtime,
                                                   const model::ModelFile& model, const model::Tier& tier,
                                                   const LoadLimits& limits, const skeleton::NativeParts& native) {
    if (tier.usesSkeleton()) {
        return std::make_unique<SkeletonLevelEstimator>(skeleton::sharedOrRead(native, model).level);
    }
    return std::make_unique<OnnxLevelEstimator>(
        GraphSource{requireRuntime(std::move(runtime), tier), model, tier, levelBatch, limits});
}

SolverSettings defaultSolver(const model::Tier& tier) noexcept {
    return {tier.solver, tier.steps};
}

std::shared_ptr<GraphSession> GraphSource::load(const std::string& blob, const GraphSignature& signature,
                                                std::size_t batch) const {
    const auto loadOwn = [&]() -> std::shared_ptr<GraphSession> {
        const std::string name = "tier \"" + tier.name + "\", graph \"" + blob + '"';
        limits.check();
        model::checkOnnxModel(model.blob(blob), name);
        return loadGraphSession(runtime, model.blob(blob), name, signature, batch, limits);
    };
    return sessions != nullptr ? sessions->getOrLoad(blob, signature, batch, loadOwn) : loadOwn();
}

void checkSolverSettings(const SolverSettings& settings) {
    if (settings.steps < 1 || settings.steps > maximumSolverSteps) {
        throw std::invalid_argument("the solver has " + std::to_string(settings.steps) + " steps; expected 1 to 16");
    }
}

std::size_t requireBatch(std::size_t batch) {
    if (batch < 1 || batch > maximumBatchSize) {
        throw std::invalid_argument("the maximum batch is " + std::to_string(batch) + "; expected 1 to 256");
    }
    return batch;
}

void requireSize(std::size_t found, std::size_t expected, const char* what) {
    if (found != expected) {
        throw std::invalid_argument(std::string(what) + " for " + std::to_string(expected) + " numbers; found " +
                                    std::to_string(found));
    }
}

float levelOf(const SegmentRequest& request, float logLevel, const char* source) {
    if (!std::isfinite(logLevel) || logLevel > static_cast<float>(maximumLogLevel)) {
        throw InferenceError(std::string("the ") + source + " returned a logarithm of " + std::to_string(logLevel) +
                             "; expected a number up to 20");
    }
    // Lower levels cannot be felt, and dividing the previous waveform by them would overflow.
    return std::exp(std::max(logLevel, static_cast<float>(-maximumLogLevel))) * request.levelGain;
}

}  // namespace haptoflow::inference
