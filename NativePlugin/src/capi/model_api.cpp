#include "capi/handles.hpp"
#include "model/file_layout.hpp"

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

using namespace haptoflow;
using namespace haptoflow::capi;

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

haptoflow_solver solverOf(model::SolverKind solver) {
    switch (solver) {
        case model::SolverKind::euler:
            return HAPTOFLOW_SOLVER_EULER;
        case model::SolverKind::heun:
            return HAPTOFLOW_SOLVER_HEUN;
        case model::SolverKind::midpoint:
            break;
    }
    return HAPTOFLOW_SOLVER_MIDPOINT;
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
    info.solver = solverOf(tier.solver);
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
    return guarded([&] {
        const auto open = models().get(model);
        *require(header_json, "header_json") = open->headerText.c_str();
    });
}

haptoflow_status haptoflow_model_describe(const haptoflow_model* model, haptoflow_model_info* info) {
    return guarded([&] {
        const auto open = models().get(model);
        writeDescriptor(info, describe(open->model.header()), "info");
    });
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
    return guarded([&] {
        const auto open = models().get(model);
        *require(space, "space") = open->space.c_str();
    });
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
