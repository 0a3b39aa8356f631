#include "capi/handles.hpp"
#include "inference/tier_graphs.hpp"
#include "skeleton/rib_rates.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

using namespace haptoflow;
using namespace haptoflow::capi;

static_assert(inference::segmentSamples == HAPTOFLOW_SEGMENT_SAMPLES);
static_assert(inference::embeddingSize == HAPTOFLOW_EMBEDDING_SIZE);
static_assert(skeleton::Phases{}.size() == HAPTOFLOW_PHASES);
static_assert(inference::maximumBatchSize == HAPTOFLOW_MAXIMUM_BATCH);

namespace {

constexpr uint32_t defaultBatch = 8;
constexpr std::size_t motionSize = HAPTOFLOW_MOTION_SIZE;


float requireLevel(float levelMps2) {
    if (!(levelMps2 > 0.0F && levelMps2 <= 1e6F)) {
        throw std::invalid_argument("batch: own_levels_mps2 holds " + std::to_string(levelMps2) +
                                    "; expected above 0 to 1000000");
    }
    return levelMps2;
}

inference::SolverSettings solverSettings(haptoflow_solver solver, int32_t steps,
                                         const inference::SolverSettings& tierSolver) {
    switch (solver) {
        case HAPTOFLOW_SOLVER_OF_TIER:
            if (steps != 0) {
                throw std::invalid_argument("steps must be 0 with HAPTOFLOW_SOLVER_OF_TIER");
            }
            return tierSolver;
        case HAPTOFLOW_SOLVER_EULER:
            return {inference::SolverKind::euler, steps};
        case HAPTOFLOW_SOLVER_MIDPOINT:
            return {inference::SolverKind::midpoint, steps};
        case HAPTOFLOW_SOLVER_HEUN:
            return {inference::SolverKind::heun, steps};
        default:
            throw std::invalid_argument("solver is " + std::to_string(solver) + "; expected 0 to 3");
    }
}

std::span<const float, inference::segmentSamples> waveformAt(const float* waveforms, std::size_t index) {
    return std::span<const float, inference::segmentSamples>(waveforms + index * inference::segmentSamples,
                                                             inference::segmentSamples);
}

std::vector<inference::SegmentRequest> requestsOf(const haptoflow_batch* batch, std::size_t latentSize) {
    const auto given = readDescriptor(batch, "batch");
    (void)require(given.embeddings, "batch: embeddings");
    (void)require(given.motions, "batch: motions");
    (void)require(given.previous_mps2, "batch: previous_mps2");
    (void)require(given.noise, "batch: noise");
    if (given.latent_noise != nullptr && latentSize == 0) {
        throw std::invalid_argument(
            "batch: latent_noise is given, but the tier's representation is not latent; expected "
            "null");
    }
    std::vector<inference::SegmentRequest> requests;
    requests.reserve(given.count);
    for (std::size_t index = 0; index < given.count; ++index) {
        inference::SegmentRequest request{
            {}, {}, waveformAt(given.previous_mps2, index), waveformAt(given.noise, index)};
        std::copy_n(given.embeddings + index * inference::embeddingSize, inference::embeddingSize,
                    request.embedding.begin());
        std::copy_n(given.motions + index * motionSize, motionSize, request.motion.begin());
        request.phases = skeleton::phasesOf(request.embedding, request.motion, {});
        if (given.phases != nullptr) {
            std::copy_n(given.phases + index * request.phases.size(), request.phases.size(), request.phases.begin());
        }
        if (given.latent_noise != nullptr) {
            request.latentNoise = {given.latent_noise + index * latentSize, latentSize};
        }
        if (given.own_levels_mps2 != nullptr) {
            request.levelMps2 = requireLevel(given.own_levels_mps2[index]);
        }
        requests.push_back(request);
    }
    return requests;
}

}  // namespace

haptoflow_status haptoflow_generator_create(const haptoflow_generator_options* options,
                                            haptoflow_generator** generator) {
    return guarded([&] {
        const auto given = readDescriptor(options, "options");
        (void)require(generator, "generator");
        const auto runtime = runtimeOf(given.runtime);
        const auto open = models().get(given.model);
        const model::Tier& tier = tierNamed(open->model, given.tier);
        const auto tierSolver = inference::defaultSolver(tier);
        const uint32_t batch = given.maximum_batch != 0 ? given.maximum_batch : defaultBatch;
        auto loaded = inference::makeGenerator(runtime, open->model, tier, tierSolver, batch,
                                               loadLimits(given.cancellation, given.probe_limit_ms), open->native);
        const bool isLatent = tier.representation == model::TierRepresentation::latent;
        *generator = generators().open(std::shared_ptr<OpenGenerator>(
            new OpenGenerator{{}, tierSolver, std::move(loaded), isLatent ? inference::pointSize(tier) : 0}));
    });
}

haptoflow_status haptoflow_generator_close(haptoflow_generator** generator) {
    return guarded([&] { closeHandle(generators(), generator, "generator"); });
}

haptoflow_status haptoflow_generator_set_solver(haptoflow_generator* generator, haptoflow_solver solver,
                                                int32_t steps) {
    return guarded([&] {
        const auto open = generators().get(generator);
        const std::lock_guard lock(open->mutex);
        open->generator->setSolver(solverSettings(solver, steps, open->tierSolver));
    });
}

haptoflow_status haptoflow_generator_generate(haptoflow_generator* generator, const haptoflow_batch* batch,
                                              float* segments_mps2) {
    return guarded([&] {
        const auto open = generators().get(generator);
        const auto requests = requestsOf(batch, open->latentSize);
        const std::span<float> segments(require(segments_mps2, "segments_mps2"),
                                        requests.size() * inference::segmentSamples);
        const std::lock_guard lock(open->mutex);
        open->generator->generate(requests, segments);
    });
}
