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

inline std::string message() {
    return haptoflow_last_message();
}

inline std::vector<char> tinyModelBytes() {
    std::ifstream stream(tinyModelPath, std::ios::binary);
    std::vector<char> bytes((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
    EXPECT_GT(bytes.size(), 1000U) << tinyModelPath << " is missing";
    return bytes;
}

inline haptoflow_runtime* openRuntime() {
    const haptoflow_runtime_options options{sizeof(options), nullptr, HAPTOFLOW_TEST_ONNXRUNTIME, nullptr, nullptr};
    haptoflow_runtime* runtime = nullptr;
    EXPECT_EQ(haptoflow_runtime_open(&options, &runtime), HAPTOFLOW_OK) << message();
    return runtime;
}

inline haptoflow_model* openTinyModel() {
    const haptoflow_model_options options{sizeof(options), nullptr, 0, tinyModelPath.c_str()};
    haptoflow_model* model = nullptr;
    EXPECT_EQ(haptoflow_model_open(&options, &model), HAPTOFLOW_OK) << message();
    return model;
}

/// A runtime and the tiny model, closed at the end of the test.
class WithTinyModel : public ::testing::Test {
protected:
    void TearDown() override {
        EXPECT_EQ(haptoflow_model_close(&model_), HAPTOFLOW_OK);
        EXPECT_EQ(haptoflow_runtime_close(&runtime_), HAPTOFLOW_OK);
    }

    [[nodiscard]] haptoflow_generator_options generatorOptions(const char* tier = nullptr) const {
        haptoflow_generator_options options{};
        options.struct_size = sizeof(options);
        options.runtime = runtime_;
        options.model = model_;
        options.tier = tier;
        return options;
    }

    haptoflow_runtime* runtime_ = openRuntime();
    haptoflow_model* model_ = openTinyModel();
};

}  // namespace haptoflow::capi::testing
