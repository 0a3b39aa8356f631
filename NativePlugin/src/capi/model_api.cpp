#include "capi/handles.hpp"
#include "engine/material_library.hpp"
#include "inference/tier_generator.hpp"
#include "model/file_layout.hpp"
#include "model/material_file.hpp"
#include "skeleton/condition.hpp"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

using namespace haptoflow;
using namespace haptoflow::capi;

static_assert(HAPTOFLOW_SOLVER_EULER + static_cast<int>(model::SolverKind::midpoint) == HAPTOFLOW_SOLVER_MIDPOINT);
static_assert(HAPTOFLOW_SOLVER_EULER + static_cast<int>(model::SolverKind::heun) == HAPTOFLOW_SOLVER_HEUN);

namespace {

model::ModelFile openModel(const haptoflow_model_options& options) {
    if ((options.bytes == nullptr) == (options.path == nullptr)) {
        throw std::invalid_argument("options: exactly one of bytes and path must be set");
    }
    if (options.path != nullptr) {
        return model::ModelFile::read(utf8Path(options.path));
    }
    // Checked here, before that much memory is allocated.
    if (options.byte_count > model::maximumFileBytes) {
        throw model::ModelError(model::ModelStatus::oversized,
                                "byte_count is " + std::to_string(options.byte_count) + "; the limit is 268435456");
    }
    const auto* first = static_cast<const std::byte*>(options.bytes);
    return model::ModelFile::parse(std::vector<std::byte>(first, first + options.byte_count));
}

template <typename Element>
const Element& elementAt(const std::vector<Element>& elements, uint32_t index, const char* what) {
    if (index >= elements.size()) {
        throw std::invalid_argument("index " + std::to_string(index) + ": the model has " +
                                    std::to_string(elements.size()) + ' ' + what);
    }
    return elements[index];
}

haptoflow_model_info describe(const model::ModelHeader& header) {
    haptoflow_model_info info{};
    info.name = header.name.c_str();
    info.description = header.description.c_str();
    info.statement = header.provenance.statement.c_str();
    info.recordings = header.provenance.recordings.c_str();
    info.licence = header.provenance.licence.c_str();
    info.commit = header.provenance.commit.c_str();
    info.created = header.provenance.created.c_str();
    info.speed_mps[0] = header.speedMps.minimum;
    info.speed_mps[1] = header.speedMps.maximum;
    info.force_newtons[0] = header.forceNewtons.minimum;
    info.force_newtons[1] = header.forceNewtons.maximum;
    return info;
}

haptoflow_tier_info describe(const model::Tier& tier, bool isDefault) {
    haptoflow_tier_info info{};
    info.steps = tier.steps;
    info.name = tier.name.c_str();
    // The names are literals, which end with a zero byte.
    info.kind = model::kindName(tier.kind).data();
    info.accuracy_json = tier.accuracyJson.c_str();
    info.cost_json = tier.costJson.c_str();
    info.solver = HAPTOFLOW_SOLVER_EULER + static_cast<int>(tier.solver);
    info.is_default = isDefault ? 1 : 0;
    info.parameter_count = tier.parameters;
    return info;
}

}  // namespace

haptoflow_status haptoflow_model_open(const haptoflow_model_options* options, haptoflow_model** model) {
    return guarded([&] {
        const auto given = readDescriptor(options, "options");
        (void)require(model, "model");
        *model = models().open(std::make_shared<OpenModel>(openModel(given)));
    });
}

haptoflow_status haptoflow_model_close(haptoflow_model** model) {
    return guarded([&] { closeHandle(models(), model, "model"); });
}

haptoflow_status haptoflow_model_header(const haptoflow_model* model, const char** header_json) {
    return guarded([&] { *require(header_json, "header_json") = models().get(model)->headerText.c_str(); });
}

haptoflow_status haptoflow_model_describe(const haptoflow_model* model, haptoflow_model_info* info) {
    return guarded([&] { writeDescriptor(info, describe(models().get(model)->model.header()), "info"); });
}

haptoflow_status haptoflow_model_label_count(const haptoflow_model* model, uint32_t* count) {
    return guarded([&] {
        const auto open = models().get(model);
        *require(count, "count") = static_cast<uint32_t>(open->model.header().labels.size());
    });
}

haptoflow_status haptoflow_model_label(const haptoflow_model* model, uint32_t index, haptoflow_label_info* info) {
    return guarded([&] {
        const auto open = models().get(model);
        writeDescriptor(info, describe(elementAt(open->model.header().labels, index, "labels")), "info");
    });
}

haptoflow_status haptoflow_model_embedding(const haptoflow_model* model, uint32_t index, float* embedding) {
    return guarded([&] {
        const auto open = models().get(model);
        (void)elementAt(open->model.header().labels, index, "labels");
        std::ranges::copy(open->model.embedding(index), require(embedding, "embedding"));
    });
}

haptoflow_status haptoflow_model_nearest_label(const haptoflow_model* model, const float* embedding, uint32_t* index) {
    return guarded([&] {
        const auto open = models().get(model);
        const std::span<const float, model::embeddingSize> wanted(require(embedding, "embedding"),
                                                                  model::embeddingSize);
        *require(index, "index") = static_cast<uint32_t>(open->model.nearestLabel(wanted));
    });
}

haptoflow_status haptoflow_model_space(const haptoflow_model* model, const char** space) {
    return guarded([&] { *require(space, "space") = models().get(model)->space.c_str(); });
}

haptoflow_status haptoflow_model_tier_count(const haptoflow_model* model, uint32_t* count) {
    return guarded([&] {
        const auto open = models().get(model);
        *require(count, "count") = static_cast<uint32_t>(open->model.header().tiers.size());
    });
}

haptoflow_status haptoflow_model_tier(const haptoflow_model* model, uint32_t index, haptoflow_tier_info* info) {
    return guarded([&] {
        const auto open = models().get(model);
        const model::ModelHeader& header = open->model.header();
        writeDescriptor(info, describe(elementAt(header.tiers, index, "tiers"), index == header.defaultTier), "info");
    });
}

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
    if (solver < HAPTOFLOW_SOLVER_OF_TIER || solver > HAPTOFLOW_SOLVER_HEUN) {
        throw std::invalid_argument("solver is " + std::to_string(solver) + "; expected 0 to 3");
    }
    if (solver != HAPTOFLOW_SOLVER_OF_TIER) {
        return {static_cast<inference::SolverKind>(solver - HAPTOFLOW_SOLVER_EULER), steps};
    }
    if (steps != 0) {
        throw std::invalid_argument("steps must be 0 with HAPTOFLOW_SOLVER_OF_TIER");
    }
    return tierSolver;
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
        const uint32_t batch = given.maximum_batch != 0 ? given.maximum_batch : defaultBatch;
        auto opened = std::make_shared<OpenGenerator>();
        opened->tierSolver = inference::defaultSolver(tier);
        opened->generator =
            inference::makeGenerator(runtime, open->model, tier, opened->tierSolver, batch,
                                     loadLimits(given.cancellation, given.probe_limit_ms), open->native);
        const bool isLatent = tier.representation == model::TierRepresentation::latent;
        opened->latentSize = isLatent ? inference::pointSize(tier) : 0;
        *generator = generators().open(std::move(opened));
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

static_assert(engine::MaterialLibrary::maximumRegistered == HAPTOFLOW_MAXIMUM_MATERIALS);

namespace {

model::MaterialFile readJson(const char* json, uint64_t length) {
    (void)require(json, "json");
    // Checked here, before that many bytes are read.
    if (length > model::maximumMaterialBytes) {
        throw model::MaterialError("length is " + std::to_string(length) + "; the limit is " +
                                   std::to_string(model::maximumMaterialBytes));
    }
    return model::parseMaterial(std::string_view(json, static_cast<std::size_t>(length)));
}

haptoflow_material_info describe(const model::MaterialFile& material) {
    haptoflow_material_info info{};
    info.name = material.label.name.c_str();
    info.category = material.label.category.c_str();
    info.description = material.description.c_str();
    info.space = material.space.c_str();
    info.statement = material.provenance.statement.c_str();
    info.recordings = material.provenance.recordings.c_str();
    info.licence = material.provenance.licence.c_str();
    info.created = material.provenance.created.c_str();
    info.seconds = material.provenance.seconds;
    info.stiffness_newtons_per_metre = material.label.stiffnessNewtonsPerMetre;
    info.level_offset_db = material.label.levelOffsetDb;
    std::ranges::copy(material.speedMps, info.speed_mps);
    std::ranges::copy(material.forceNewtons, info.force_newtons);
    return info;
}

/// Loads the level graph at its first use. Only while OpenEngine::registering is locked.
engine::MaterialLibrary::LevelSource levelsOf(OpenEngine& open) {
    return [&open]() -> inference::LevelEstimator& {
        if (open.levels == nullptr) {
            const model::ModelHeader& header = open.model->model.header();
            open.levels =
                inference::makeLevelEstimator(open.runtime, open.model->model, header.tiers[header.defaultTier],
                                              {.probeLimitMs = open.probeLimitMs}, open.model->native);
        }
        return *open.levels;
    };
}

}  // namespace

haptoflow_status haptoflow_material_read(const char* json, uint64_t length, haptoflow_material** material) {
    return guarded([&] {
        (void)require(material, "material");
        *material = materials().open(std::make_shared<model::MaterialFile>(readJson(json, length)));
    });
}

haptoflow_status haptoflow_material_close(haptoflow_material** material) {
    return guarded([&] { closeHandle(materials(), material, "material"); });
}

haptoflow_status haptoflow_material_describe(const haptoflow_material* material, haptoflow_material_info* info) {
    return guarded([&] { writeDescriptor(info, describe(*materials().get(material)), "info"); });
}

haptoflow_status haptoflow_material_embedding(const haptoflow_material* material, float* embedding) {
    return guarded([&] { std::ranges::copy(materials().get(material)->embedding, require(embedding, "embedding")); });
}

haptoflow_status haptoflow_engine_register_material(haptoflow_engine* engine, const char* json, uint64_t length,
                                                    uint32_t* index) {
    return guarded([&] {
        (void)require(index, "index");
        const auto open = engines().get(engine);
        model::MaterialFile material = readJson(json, length);
        const std::lock_guard lock(open->registering);
        *index = static_cast<uint32_t>(open->engine->materials().add(std::move(material), levelsOf(*open)));
    });
}

haptoflow_status haptoflow_engine_replace_material(haptoflow_engine* engine, uint32_t index, const char* json,
                                                   uint64_t length) {
    return guarded([&] {
        const auto open = engines().get(engine);
        model::MaterialFile material = readJson(json, length);
        const std::lock_guard lock(open->registering);
        open->engine->materials().replace(index, std::move(material), levelsOf(*open));
    });
}

haptoflow_status haptoflow_engine_material_count(const haptoflow_engine* engine, uint32_t* count) {
    return guarded([&] {
        const auto open = engines().get(engine);
        *require(count, "count") = static_cast<uint32_t>(open->engine->materials().registeredCount());
    });
}

haptoflow_status haptoflow_engine_material(const haptoflow_engine* engine, uint32_t index, haptoflow_label_info* info) {
    return guarded([&] {
        const auto open = engines().get(engine);
        open->engine->materials().showLabel(
            index, [info](const model::Label& label) { writeDescriptor(info, describe(label), "info"); });
    });
}
