#pragma once

#include "capi/boundary.hpp"
#include "capi/handle_table.hpp"
#include "engine/live_engine.hpp"
#include "haptoflow/haptoflow.h"
#include "inference/onnx_segment_generator.hpp"
#include "model/model_file.hpp"

#include <memory>
#include <mutex>
#include <string>
#include <utility>

namespace haptoflow::capi {

struct OpenModel {
    explicit OpenModel(model::ModelFile file) : model(std::move(file)), headerText(model.headerText()) {}

    model::ModelFile model;
    /// With the zero byte at its end that the file's own copy lacks.
    std::string headerText;
};

struct OpenGenerator {
    std::mutex mutex;
    inference::SolverSettings tierSolver;
    inference::OnnxSegmentGenerator generator;
};

struct OpenEngine {
    OpenEngine(std::shared_ptr<engine::LiveEngine> live, bool worker) : engine(std::move(live)), hasWorker(worker) {}

    std::shared_ptr<engine::LiveEngine> engine;
    bool hasWorker;
    /// Steps by hand queue up.
    std::mutex stepping;
};

using RuntimeTable = HandleTable<haptoflow_runtime, const inference::Runtime>;
using ModelTable = HandleTable<haptoflow_model, const OpenModel>;
using GeneratorTable = HandleTable<haptoflow_generator, OpenGenerator>;
using EngineTable = HandleTable<haptoflow_engine, OpenEngine>;

// The tables are never destroyed: ONNX Runtime may be gone by the time that static objects are.
[[nodiscard]] RuntimeTable& runtimes();
[[nodiscard]] ModelTable& models();
[[nodiscard]] GeneratorTable& generators();
[[nodiscard]] EngineTable& engines();

/// Closes *handle and makes it null; a null handle is fine, a null pointer to one is not.
template <typename Table, typename Handle>
void closeHandle(Table& table, Handle** handle, const char* name) {
    if (*require(handle, name) != nullptr) {
        table.close(*handle);
        *handle = nullptr;
    }
}

}  // namespace haptoflow::capi
