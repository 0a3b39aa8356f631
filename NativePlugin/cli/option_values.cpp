#include "option_values.hpp"

#include "dsp/sample_rates.hpp"
#include "headless/command_files.hpp"
#include "inference/load_limits.hpp"
#include "messages.hpp"
#include "model/plain_text.hpp"
#include "recordings/table_rows.hpp"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

#if defined(__APPLE__)
#include <mach-o/dyld.h>
#endif

namespace haptoflow::cli {
namespace {

std::string expectation(const std::string& kind, const std::string& lowest, const std::string& highest,
                        const std::string& unit) {
    return kind + " from " + lowest + " to " + highest + (unit.empty() ? "" : " " + unit);
}

}  // namespace

CLI::Validator decimalBetween(double lowest, double highest, const std::string& unit) {
    const std::string expected = expectation("a number", model::shortNumber(lowest), model::shortNumber(highest), unit);
    const auto check = [lowest, highest, expected](std::string& text) {
        const std::optional<double> value = recordings::decimalNumber(text);
        return value && *value >= lowest && *value <= highest ? std::string()
                                                              : "expected " + expected + ", found '" + text + "'";
    };
    return {check, model::shortNumber(lowest) + " to " + model::shortNumber(highest), expected};
}

CLI::Validator wholeBetween(std::uint64_t lowest, std::uint64_t highest, const std::string& unit) {
    const std::string expected = expectation("a whole number", std::to_string(lowest), std::to_string(highest), unit);
    const auto check = [lowest, highest, expected](std::string& text) {
        std::uint64_t value = 0;
        const char* const end = text.data() + text.size();
        const auto [stop, error] = std::from_chars(text.data(), end, value);
        if (error != std::errc() || stop != end || value < lowest || value > highest) {
            return "expected " + expected + ", found '" + text + "'";
        }
        // CLI11 would read a leading zero as octal.
        text = std::to_string(value);
        return std::string();
    };
    return {check, std::to_string(lowest) + " to " + std::to_string(highest), expected};
}

CLI::Validator outputRate() {
    return wholeBetween(static_cast<std::uint64_t>(dsp::minimumOutputRateHz),
                        static_cast<std::uint64_t>(dsp::maximumOutputRateHz), "Hz");
}

effects::ActuatorProfile readActuatorProfile(const std::string& nameOrPath) {
    if (std::optional<effects::ActuatorProfile> builtIn = effects::ActuatorProfile::builtIn(nameOrPath)) {
        return *std::move(builtIn);
    }
    const std::string text =
        headless::readInputFile("the actuator profile", nameOrPath,
                                "an actuator profile (JSON), or the name of a built-in one: flat, voice-coil");
    try {
        return effects::ActuatorProfile::parse(text);
    } catch (const effects::ProfileError& error) {
        throw InputError(nameOrPath + ": " + error.what());
    }
}

namespace {

namespace fs = std::filesystem;

#if defined(__APPLE__)
constexpr const char* runtimeFile = "libonnxruntime.dylib";
constexpr const char* runtimeFolder = "macOS/arm64";
#else
constexpr const char* runtimeFile = "libonnxruntime.so";
constexpr const char* runtimeFolder = "Linux/x64";
#endif

fs::path executableFolder() {
#if defined(__APPLE__)
    std::vector<char> name(32'768);
    auto size = static_cast<std::uint32_t>(name.size());
    if (_NSGetExecutablePath(name.data(), &size) != 0) {
        return {};
    }
    std::error_code ignored;
    return fs::canonical(name.data(), ignored).parent_path();
#else
    std::error_code ignored;
    return fs::read_symlink("/proc/self/exe", ignored).parent_path();
#endif
}

std::optional<fs::path> fromEnvironment(const char* variable) {
    // Safe, because no thread of this program changes the environment.
    const char* value = std::getenv(variable);  // NOLINT(concurrency-mt-unsafe)
    if (value == nullptr || *value == '\0') {
        return std::nullopt;
    }
    return fs::path(value);
}

/// The first candidate that is a file; a path in the environment variable replaces all candidates.
fs::path find(const std::string& what, const char* variable, const std::vector<fs::path>& candidates,
              const std::string& remedy) {
    std::error_code ignored;
    if (const auto named = fromEnvironment(variable)) {
        if (fs::is_regular_file(*named, ignored)) {
            return *named;
        }
        throw InputError(named->string() + ": no such file; the environment variable " + variable + " names it as " +
                         what);
    }
    std::string message = what + " was not found. Looked at " + variable + " (not set)";
    for (const fs::path& candidate : candidates) {
        fs::path tidy = candidate.lexically_normal();
        if (fs::is_regular_file(tidy, ignored)) {
            return tidy;
        }
        message += ", " + tidy.string();
    }
    throw InputError(message + ". " + remedy);
}

}  // namespace

fs::path findModel(const std::string& given) {
    const fs::path folder = executableFolder();
    fs::path model =
        !given.empty()
            ? fs::path(given)
            : find("the default model", "HAPTOFLOW_MODEL",
                   {folder / "default.haptoflow",
                    folder / "../../Packages/com.haptoflow.runtime/Runtime/Models/default.haptoflow"},
                   "Name a model with --model, or run the program that `npm run build` makes inside a checkout.");
    headless::claimInput("the model", model);
    return model;
}

fs::path findOnnxRuntime() {
    const fs::path folder = executableFolder();
    const fs::path package = folder / "../../node_modules/com.github.asus4.onnxruntime/Plugins";
    fs::path library =
        find("ONNX Runtime's library", "HAPTOFLOW_ONNXRUNTIME",
             {folder / runtimeFile, package / runtimeFolder / runtimeFile},
             "Run `npm ci` and `npm run build` in the repository's root, or set the variable to the library.");
    headless::claimInput("ONNX Runtime", library);
    return library;
}

model::ModelFile readModel(const fs::path& path) {
    std::error_code ignored;
    if (fs::is_directory(path, ignored)) {
        throw InputError(path.string() + ": is a folder; expected a model file (.haptoflow)");
    }
    try {
        return model::ModelFile::read(path);
    } catch (const model::ModelError& error) {
        throw InputError(error.what());
    }
}

std::shared_ptr<const inference::Runtime> openRuntime() {
    try {
        return inference::Runtime::open(findOnnxRuntime());
    } catch (const inference::RuntimeUnavailable& error) {
        throw InputError(error.what());
    }
}

std::shared_ptr<const inference::Runtime> openRuntimeFor(std::span<const model::Tier> tiers) {
    return std::ranges::any_of(tiers, &model::Tier::needsOnnxRuntime) ? openRuntime() : nullptr;
}

std::string listed(std::span<const std::string> words) {
    std::string text;
    for (const std::string& word : words) {
        text += (text.empty() ? "" : ", ") + word;
    }
    return text;
}

const model::Tier& chooseTier(const model::ModelFile& model, const std::string& quality) {
    if (quality.empty()) {
        return model.header().tiers[model.header().defaultTier];
    }
    if (const model::Tier* tier = model.findTier(quality)) {
        return *tier;
    }
    std::vector<std::string> tiers;
    std::ranges::transform(model.header().tiers, std::back_inserter(tiers), &model::Tier::name);
    const std::string meant = headless::suggestion(quality, tiers);
    throw UsageError("--quality " + quality + ": " + (meant.empty() ? "" : meant + " ") + "This model has " +
                     listed(tiers));
}

}  // namespace haptoflow::cli
