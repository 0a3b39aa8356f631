#include "model_location.hpp"

#include "headless/scenes/command_files.hpp"
#include "inference/inference_error.hpp"
#include "messages.hpp"

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <system_error>
#include <vector>

#if defined(__APPLE__)
#include <mach-o/dyld.h>
#endif

namespace haptoflow::cli {
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
    // No other thread changes the environment.
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
        const fs::path tidy = candidate.lexically_normal();
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

}  // namespace haptoflow::cli
