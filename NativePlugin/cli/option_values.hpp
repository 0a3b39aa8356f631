#pragma once

#include "effects/actuator_profile.hpp"
#include "inference/onnx_runtime.hpp"
#include "model/model_file.hpp"

#include <CLI/CLI.hpp>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

namespace haptoflow::cli {

/// Accepts decimal numbers from `lowest` to `highest`; unlike CLI11's own CLI::Range, no "nan", "inf" or hexadecimal.
[[nodiscard]] CLI::Validator decimalBetween(double lowest, double highest, const std::string& unit);

/// Accepts whole numbers in decimal digits from `lowest` to `highest`, without sign. As `transform` it removes leading
/// zeros, which CLI11 would read as octal.
[[nodiscard]] CLI::Validator wholeBetween(std::uint64_t lowest, std::uint64_t highest, const std::string& unit);

/// Accepts the sample rates in Hz that the output of a voice supports.
[[nodiscard]] CLI::Validator outputRate();

/// The built-in actuator profile of this name, otherwise the profile in this file. Throws InputError that names the
/// file and the key.
[[nodiscard]] effects::ActuatorProfile readActuatorProfile(const std::string& nameOrPath);

/// The model to use: `given` if it is not empty; otherwise the path in the environment variable HAPTOFLOW_MODEL;
/// otherwise default.haptoflow beside the executable; otherwise that of the checkout in which the executable was built
/// (../../Packages/com.haptoflow.runtime/Runtime/Models). Throws InputError that names all of these places.
[[nodiscard]] std::filesystem::path findModel(const std::string& given);

/// ONNX Runtime's library: the path in the environment variable HAPTOFLOW_ONNXRUNTIME; otherwise the library beside the
/// executable; otherwise the npm package of the checkout (../../node_modules/com.github.asus4.onnxruntime/Plugins).
/// Throws InputError that names all of these places.
[[nodiscard]] std::filesystem::path findOnnxRuntime();

/// Reads a model; errors become InputError.
[[nodiscard]] model::ModelFile readModel(const std::filesystem::path& path);

/// How the words of a sentence are listed: "a, b".
[[nodiscard]] std::string listed(std::span<const std::string> words);

/// The tier of this name; the default tier for an empty one. Throws UsageError that lists the model's.
[[nodiscard]] const model::Tier& chooseTier(const model::ModelFile& model, const std::string& quality);

/// Opens the ONNX Runtime that findOnnxRuntime finds; errors become InputError.
[[nodiscard]] std::shared_ptr<const inference::Runtime> openRuntime();
/// The same where one of the tiers needs it; null otherwise.
[[nodiscard]] std::shared_ptr<const inference::Runtime> openRuntimeFor(std::span<const model::Tier> tiers);

}  // namespace haptoflow::cli
