#pragma once

#include "capi/boundary.hpp"
#include "capi/handle_table.hpp"
#include "engine/live_engine.hpp"
#include "haptoflow/haptoflow.h"
#include "inference/load_limits.hpp"
#include "inference/tier_generator.hpp"
#include "model/material_file.hpp"
#include "model/model_file.hpp"
#include "skeleton/skeleton_tensors.hpp"

#include <cstddef>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

namespace haptoflow::capi {

struct OpenModel {
    explicit OpenModel(model::ModelFile file)
        : model(std::move(file)),
          native(skeleton::readNativeParts(model)),
          headerText(model.headerText()),
          space(model::spaceOf(model.header())) {}

    model::ModelFile model;
    /// Shared by all generators of the model.
    skeleton::NativeParts native;
    /// The file's header with a final zero byte, which the file itself does not have.
    std::string headerText;
    std::string space;
};

struct OpenGenerator {
    std::mutex mutex;
    inference::SolverSettings tierSolver;
    std::unique_ptr<inference::TierGenerator> generator;
    /// Numbers of a latent; 0 unless the tier's representation is latent.
    std::size_t latentSize = 0;
};

struct OpenEngine {
    OpenEngine(std::shared_ptr<engine::LiveEngine> live, bool worker, std::shared_ptr<const inference::Runtime> given,
               std::shared_ptr<const OpenModel> opened, double limitMs)
        : engine(std::move(live)),
          hasWorker(worker),
          runtime(std::move(given)),
          model(std::move(opened)),
          probeLimitMs(limitMs) {}

    std::shared_ptr<engine::LiveEngine> engine;
    bool hasWorker;
    /// Null if the caller has none.
    const std::shared_ptr<const inference::Runtime> runtime;
    const std::shared_ptr<const OpenModel> model;
    const double probeLimitMs;
    /// Serialises calls of haptoflow_engine_step.
    std::mutex stepping;
    /// Serialises registrations, which share a level graph that the first one that needs it loads.
    std::mutex registering;
    std::unique_ptr<inference::LevelEstimator> levels;
};

/// The info of a label for C callers; its texts are valid as long as the label.
[[nodiscard]] haptoflow_label_info describe(const model::Label& label);

using RuntimeTable = HandleTable<haptoflow_runtime, const inference::Runtime>;
using CancellationTable = HandleTable<haptoflow_cancellation, inference::Cancellation>;
using ModelTable = HandleTable<haptoflow_model, const OpenModel>;
using GeneratorTable = HandleTable<haptoflow_generator, OpenGenerator>;
using EngineTable = HandleTable<haptoflow_engine, OpenEngine>;
struct OpenWaveFeatures;
using WaveFeaturesTable = HandleTable<haptoflow_wave_features, OpenWaveFeatures>;
struct OpenDeviceWave;
using DeviceWaveTable = HandleTable<haptoflow_device_wave, OpenDeviceWave>;
struct OpenRecording;
using RecordingTable = HandleTable<haptoflow_recording, const OpenRecording>;
struct OpenLearning;
using LearningTable = HandleTable<haptoflow_learning, const OpenLearning>;
using MaterialTable = HandleTable<haptoflow_material, const model::MaterialFile>;

/// The only table of its type. It is never destroyed, because ONNX Runtime may be unloaded before static objects are
/// destroyed.
template <typename Table>
[[nodiscard]] Table& lastingTable(const char* name) {
    static auto& table = *new Table(name);
    return table;
}

[[nodiscard]] inline RuntimeTable& runtimes() {
    return lastingTable<RuntimeTable>("runtime");
}
[[nodiscard]] inline CancellationTable& cancellations() {
    return lastingTable<CancellationTable>("cancellation");
}
[[nodiscard]] inline ModelTable& models() {
    return lastingTable<ModelTable>("model");
}
[[nodiscard]] inline GeneratorTable& generators() {
    return lastingTable<GeneratorTable>("generator");
}
[[nodiscard]] inline EngineTable& engines() {
    return lastingTable<EngineTable>("engine");
}
[[nodiscard]] inline WaveFeaturesTable& waveFeatures() {
    return lastingTable<WaveFeaturesTable>("wave features");
}
[[nodiscard]] inline DeviceWaveTable& deviceWaves() {
    return lastingTable<DeviceWaveTable>("device wave");
}
[[nodiscard]] inline RecordingTable& openRecordings() {
    return lastingTable<RecordingTable>("recording");
}
[[nodiscard]] inline LearningTable& learnings() {
    return lastingTable<LearningTable>("learning");
}
[[nodiscard]] inline MaterialTable& materials() {
    return lastingTable<MaterialTable>("material");
}

/// The runtime that a handle stands for, and null for a null handle. Throws std::invalid_argument for a handle that is
/// not open.
[[nodiscard]] std::shared_ptr<const inference::Runtime> runtimeOf(const haptoflow_runtime* runtime);

/// The tier of this name, or the model's default tier if `name` is null. Throws std::invalid_argument for an unknown
/// name.
[[nodiscard]] const model::Tier& tierNamed(const model::ModelFile& model, const char* name);

/// The limits of a load from the options: a null cancellation means none, a limit of 0 the default. Throws
/// std::invalid_argument.
[[nodiscard]] inference::LoadLimits loadLimits(const haptoflow_cancellation* cancellation, double probeLimitMs);

/// Closes *handle and sets it to null; *handle may be null, `handle` must not.
template <typename Table, typename Handle>
void closeHandle(Table& table, Handle** handle, const char* name) {
    if (*require(handle, name) != nullptr) {
        table.close(*handle);
        *handle = nullptr;
    }
}

}  // namespace haptoflow::capi
