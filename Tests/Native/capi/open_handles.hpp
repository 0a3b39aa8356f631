#pragma once

#include "haptoflow/haptoflow.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace haptoflow::capi::testing {

inline const std::string tinyModelPath = HAPTOFLOW_TEST_GOLDEN_DIR "/model/tiny.haptoflow";
inline const std::string defaultModelPath = HAPTOFLOW_TEST_DEFAULT_MODEL;

inline std::string message() {
    return haptoflow_last_message();
}

/// The bytes of a file.
inline std::string textOf(const std::string& path) {
    std::ifstream stream(path, std::ios::binary);
    EXPECT_TRUE(stream) << path << " is missing";
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// A struct of the C interface with its size set.
template <typename Descriptor>
Descriptor sized() {
    Descriptor descriptor{};
    descriptor.struct_size = sizeof(Descriptor);
    return descriptor;
}

/// A handle that is closed at the end of its scope.
template <typename Type, haptoflow_status (*close)(Type**)>
class Handle {
public:
    explicit Handle(Type* handle = nullptr) : handle_(handle) {}
    Handle(const Handle&) = delete;
    Handle& operator=(const Handle&) = delete;
    ~Handle() { EXPECT_EQ(close(&handle_), HAPTOFLOW_OK) << message(); }

    // NOLINTNEXTLINE(google-explicit-constructor): it stands for the handle in every call.
    operator Type*() const { return handle_; }
    /// For the functions that set it.
    [[nodiscard]] Type** out() { return &handle_; }

private:
    Type* handle_;
};

using RuntimeHandle = Handle<haptoflow_runtime, haptoflow_runtime_close>;
using ModelHandle = Handle<haptoflow_model, haptoflow_model_close>;
using GeneratorHandle = Handle<haptoflow_generator, haptoflow_generator_close>;
using EngineHandle = Handle<haptoflow_engine, haptoflow_engine_close>;
using CancellationHandle = Handle<haptoflow_cancellation, haptoflow_cancellation_close>;
using RecordingHandle = Handle<haptoflow_recording, haptoflow_recording_close>;
using ClipHandle = Handle<haptoflow_clip, haptoflow_clip_close>;

inline haptoflow_runtime* openRuntime() {
    auto options = sized<haptoflow_runtime_options>();
    options.library_path = HAPTOFLOW_TEST_ONNXRUNTIME;
    haptoflow_runtime* runtime = nullptr;
    EXPECT_EQ(haptoflow_runtime_open(&options, &runtime), HAPTOFLOW_OK) << message();
    return runtime;
}

inline haptoflow_model* openModel(const std::string& path) {
    const haptoflow_model_options options{sizeof(options), nullptr, 0, path.c_str()};
    haptoflow_model* model = nullptr;
    EXPECT_EQ(haptoflow_model_open(&options, &model), HAPTOFLOW_OK) << message();
    return model;
}

inline haptoflow_generator_options generatorOptions(const haptoflow_runtime* runtime, const haptoflow_model* model,
                                                    const char* tier = nullptr) {
    auto options = sized<haptoflow_generator_options>();
    options.runtime = runtime;
    options.model = model;
    options.tier = tier;
    return options;
}

/// Without a worker the engine is stepped, so that its output is deterministic.
inline haptoflow_engine_options engineOptions(const haptoflow_runtime* runtime, const haptoflow_model* model,
                                              haptoflow_quality quality = HAPTOFLOW_QUALITY_DRAFT,
                                              bool hasWorker = false) {
    auto options = sized<haptoflow_engine_options>();
    options.quality = quality;
    options.runtime = runtime;
    options.model = model;
    options.seed = 1;
    options.without_worker = hasWorker ? 0 : 1;
    options.fixed_lead_ms = hasWorker ? 0.0 : 8.0;
    return options;
}

inline haptoflow_engine* createEngine(const haptoflow_engine_options& options) {
    haptoflow_engine* engine = nullptr;
    EXPECT_EQ(haptoflow_engine_create(&options, &engine), HAPTOFLOW_OK) << message();
    return engine;
}

inline haptoflow_voice_statistics statisticsOf(haptoflow_voice voice) {
    auto statistics = sized<haptoflow_voice_statistics>();
    EXPECT_EQ(haptoflow_voice_get_statistics(voice, &statistics), HAPTOFLOW_OK) << message();
    return statistics;
}

inline haptoflow_engine_statistics statisticsOf(const haptoflow_engine* engine) {
    auto statistics = sized<haptoflow_engine_statistics>();
    EXPECT_EQ(haptoflow_engine_get_statistics(engine, &statistics), HAPTOFLOW_OK) << message();
    return statistics;
}

/// A runtime and the tiny model, closed at the end of the test.
class WithTinyModel : public ::testing::Test {
protected:
    RuntimeHandle runtime_{openRuntime()};
    ModelHandle model_{openModel(tinyModelPath)};
};

}  // namespace haptoflow::capi::testing
