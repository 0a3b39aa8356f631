#pragma once

#include "inference/onnx_runtime.hpp"
#include "model/model_file.hpp"

#include <filesystem>
#include <memory>
#include <string>

namespace haptoflow::cli {

/// The model to use: `given` where it is not empty; else what the environment variable HAPTOFLOW_MODEL names; else
/// default.haptoflow beside the executable; else the one of the checkout that the executable was built in
/// (../../Packages/com.haptoflow.runtime/Runtime/Models). Throws InputError that names every place looked at.
[[nodiscard]] std::filesystem::path findModel(const std::string& given);

/// ONNX Runtime's library: what the environment variable HAPTOFLOW_ONNXRUNTIME names; else the library beside the
/// executable; else the npm package of the checkout (../../node_modules/com.github.asus4.onnxruntime/Plugins).
/// Throws InputError that names every place looked at.
[[nodiscard]] std::filesystem::path findOnnxRuntime();

/// Reads a model; a refusal becomes an InputError.
[[nodiscard]] model::ModelFile readModel(const std::filesystem::path& path);

/// Opens the ONNX Runtime that findOnnxRuntime finds; a refusal becomes an InputError.
[[nodiscard]] std::shared_ptr<const inference::Runtime> openRuntime();

}  // namespace haptoflow::cli
