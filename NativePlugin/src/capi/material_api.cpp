#include "capi/handles.hpp"
#include "engine/material_library.hpp"
#include "model/material_file.hpp"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

using namespace haptoflow;
using namespace haptoflow::capi;

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
    return guarded([&] {
        const auto open = materials().get(material);
        std::ranges::copy(open->embedding, require(embedding, "embedding"));
    });
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
