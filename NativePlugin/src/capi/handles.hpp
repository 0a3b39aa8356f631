#pragma once

#include "engine/live_engine.hpp"
#include "haptoflow/haptoflow.h"
#include "inference/load_limits.hpp"
#include "inference/tier_generator.hpp"
#include "model/material_file.hpp"
#include "model/model_file.hpp"
#include "skeleton/skeleton_tensors.hpp"

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <limits>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <unordered_map>
#include <utility>

namespace haptoflow::capi {

/// Converts the exception that is being handled into a status and stores its message for this thread.
[[nodiscard]] haptoflow_status reportCurrentException() noexcept;

/// The message of the last failed call on this thread.
[[nodiscard]] const char* lastMessage() noexcept;

/// Runs the body of a C function; no exception leaves it.
template <typename Action>
[[nodiscard]] haptoflow_status guarded(Action&& action) noexcept {
    try {
        action();
        return HAPTOFLOW_OK;
    } catch (...) {
        return reportCurrentException();
    }
}

/// Returns `pointer`. Throws std::invalid_argument that names it if it is null.
template <typename Type>
[[nodiscard]] Type* require(Type* pointer, const char* name) {
    if (pointer == nullptr) {
        throw std::invalid_argument(std::string(name) + " is null");
    }
    return pointer;
}

/// A number of samples of up to three axes. Throws std::invalid_argument that names it if no memory could hold them.
[[nodiscard]] inline std::size_t countOf(uint64_t given, const char* name) {
    constexpr uint64_t maximumSamples = std::numeric_limits<std::size_t>::max() / (3 * sizeof(float));
    if (given > maximumSamples) {
        throw std::invalid_argument(std::string(name) + " is " + std::to_string(given));
    }
    return static_cast<std::size_t>(given);
}

/// Throws std::invalid_argument unless the caller's struct has the library's size.
template <typename Descriptor>
void checkStructSize(const Descriptor* descriptor, const char* name) {
    const std::size_t size = require(descriptor, name)->struct_size;
    if (size != sizeof(Descriptor)) {
        throw std::invalid_argument(std::string(name) + ": struct_size is " + std::to_string(size) + "; expected " +
                                    std::to_string(sizeof(Descriptor)) + ", the size of the struct in this version");
    }
}

template <typename Descriptor>
[[nodiscard]] Descriptor readDescriptor(const Descriptor* descriptor, const char* name) {
    checkStructSize(descriptor, name);
    return *descriptor;
}

template <typename Descriptor>
void writeDescriptor(Descriptor* target, Descriptor content, const char* name) {
    checkStructSize(target, name);
    content.struct_size = sizeof(Descriptor);
    *target = content;
}

/// A caller's text; empty for null.
[[nodiscard]] inline std::string textOf(const char* text) {
    return text != nullptr ? text : "";
}

/// A caller's path, which is UTF-8 on every platform.
[[nodiscard]] inline std::filesystem::path utf8Path(const char* text) {
    return {std::u8string(text, text + std::strlen(text))};
}

/// Opaque handles to shared objects. A handle is a number that is never reused, not an address, so that a closed or
/// invalid handle is detected instead of dereferenced. Thread-safe.
template <typename Handle, typename Object>
class HandleTable {
public:
    explicit HandleTable(const char* kind) : kind_(kind) {}

    [[nodiscard]] Handle* open(std::shared_ptr<Object> object) {
        const std::lock_guard lock(mutex_);
        const std::uintptr_t number = nextNumber_;
        objects_.emplace(number, std::move(object));
        nextNumber_ += numberStep;
        // NOLINTNEXTLINE(performance-no-int-to-ptr): the number is never dereferenced.
        return reinterpret_cast<Handle*>(number);
    }

    /// Throws std::invalid_argument for a handle that is not open.
    [[nodiscard]] std::shared_ptr<Object> get(const Handle* handle) const {
        const std::lock_guard lock(mutex_);
        const auto found = objects_.find(reinterpret_cast<std::uintptr_t>(handle));
        if (found == objects_.end()) {
            refuse();
        }
        return found->second;
    }

    /// Throws std::invalid_argument for a handle that is not open. The object is destroyed outside the lock, when its
    /// last user releases it.
    void close(const Handle* handle) {
        std::shared_ptr<Object> last;
        const std::lock_guard lock(mutex_);
        const auto found = objects_.find(reinterpret_cast<std::uintptr_t>(handle));
        if (found == objects_.end()) {
            refuse();
        }
        last = std::move(found->second);
        objects_.erase(found);
    }

private:
    // Tools that tag the lower bits of pointers expect multiples of 16.
    static constexpr std::uintptr_t numberStep = 16;

    [[noreturn]] void refuse() const { throw std::invalid_argument(std::string("not an open ") + kind_ + " handle"); }

    const char* kind_;
    mutable std::mutex mutex_;
    std::unordered_map<std::uintptr_t, std::shared_ptr<Object>> objects_;
    std::uintptr_t nextNumber_ = numberStep;
};

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

struct OpenClip;
struct OpenDeviceWave;
struct OpenLearning;
struct OpenRecording;
struct OpenWaveFeatures;

/// The only table of its kind of handle. It is never destroyed, because ONNX Runtime may be unloaded before static
/// objects are destroyed.
template <typename Handle, typename Object>
[[nodiscard]] HandleTable<Handle, Object>& lastingTable(const char* kind) {
    static auto& table = *new HandleTable<Handle, Object>(kind);
    return table;
}

[[nodiscard]] inline auto& runtimes() {
    return lastingTable<haptoflow_runtime, const inference::Runtime>("runtime");
}
[[nodiscard]] inline auto& cancellations() {
    return lastingTable<haptoflow_cancellation, inference::Cancellation>("cancellation");
}
[[nodiscard]] inline auto& models() {
    return lastingTable<haptoflow_model, const OpenModel>("model");
}
[[nodiscard]] inline auto& generators() {
    return lastingTable<haptoflow_generator, OpenGenerator>("generator");
}
[[nodiscard]] inline auto& engines() {
    return lastingTable<haptoflow_engine, OpenEngine>("engine");
}
[[nodiscard]] inline auto& waveFeatures() {
    return lastingTable<haptoflow_wave_features, OpenWaveFeatures>("wave features");
}
[[nodiscard]] inline auto& deviceWaves() {
    return lastingTable<haptoflow_device_wave, OpenDeviceWave>("device wave");
}
[[nodiscard]] inline auto& openClips() {
    return lastingTable<haptoflow_clip, OpenClip>("clip");
}
[[nodiscard]] inline auto& openRecordings() {
    return lastingTable<haptoflow_recording, const OpenRecording>("recording");
}
[[nodiscard]] inline auto& learnings() {
    return lastingTable<haptoflow_learning, const OpenLearning>("learning");
}
[[nodiscard]] inline auto& materials() {
    return lastingTable<haptoflow_material, const model::MaterialFile>("material");
}

/// The runtime that a handle stands for, and null for a null handle. Throws std::invalid_argument for a handle that is
/// not open.
[[nodiscard]] std::shared_ptr<const inference::Runtime> runtimeOf(const haptoflow_runtime* runtime);

/// The tier of this name, or the model's default tier if `name` is null. Throws std::invalid_argument for an unknown
/// name.
[[nodiscard]] const model::Tier& tierNamed(const model::ModelFile& model, const char* name);

/// How many samples of a wave at this rate become one at 2000 Hz; a rate of 0 is 2000 Hz. Throws std::invalid_argument.
[[nodiscard]] std::size_t decimationOf(uint32_t sampleRateHz);

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
