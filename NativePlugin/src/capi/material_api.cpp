#include "capi/handles.hpp"
#include "engine/material_library.hpp"
#include "model/material_file.hpp"

#include <cstddef>
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

/// Loads the level graph at its first use. Only while OpenEngine::registering is locked.
engine::MaterialLibrary::LevelSource levelsOf(OpenEngine& open) {
    return [&open]() -> inference::LevelEstimator& {
        if (open.levels == nullptr) {
            const std::size_t tier = open.engine->model().header().defaultTier;
            open.levels = open.loader.loadLevels(tier, {.probeLimitMs = open.probeLimitMs});
        }
        return *open.levels;
    };
}

}  // namespace

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
