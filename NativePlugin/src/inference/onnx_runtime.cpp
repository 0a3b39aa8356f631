#include "inference/onnx_runtime.hpp"

#include "inference/load_limits.hpp"

#include <onnxruntime_c_api.h>

#include <algorithm>
#include <charconv>

#ifdef _WIN32
#ifndef NOMINMAX
#define NOMINMAX
#endif
#include <windows.h>
#else
#include <dlfcn.h>
#endif

namespace haptoflow::inference {
namespace {

// Version 16 of the function table has everything that is required.
constexpr std::uint32_t minimumApi = 16;
// Version 22 can cancel a load.
constexpr std::uint32_t maximumApi = 22;

using GetApiBase = const OrtApiBase*(ORT_API_CALL*)();

/// Version of the function table to request from a library of a version such as "1.29.0". Requesting a newer table than
/// the library has would make it write to the standard error stream.
std::uint32_t apiOfVersion(const std::string& version) {
    std::uint32_t minor = 0;
    if (version.starts_with("1.")) {
        (void)std::from_chars(version.data() + 2, version.data() + version.size(), minor);
    }
    return std::clamp(minor, minimumApi, maximumApi);
}

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& reason) {
    const std::u8string name = path.u8string();
    throw RuntimeUnavailable(std::string(name.begin(), name.end()) + ": " + reason);
}

/// Opens the library at `path` and returns the address of `symbol` in it. The library stays loaded until the process
/// ends: ONNX Runtime keeps threads and thread-local state that do not survive being unloaded. Throws
/// RuntimeUnavailable naming the path.
#ifdef _WIN32

[[nodiscard]] void* loadSymbol(const std::filesystem::path& path, const char* symbol) {
    // With the altered search path, dependencies are found beside the library and not beside the program.
    const DWORD flags = path.is_absolute() ? LOAD_WITH_ALTERED_SEARCH_PATH : 0;
    HMODULE library = LoadLibraryExW(path.c_str(), nullptr, flags);
    if (library == nullptr) {
        refuse(path, "cannot be loaded (Windows error " + std::to_string(GetLastError()) + ")");
    }
    void* address = reinterpret_cast<void*>(GetProcAddress(library, symbol));
    if (address == nullptr) {
        FreeLibrary(library);
        refuse(path, std::string("has no function ") + symbol);
    }
    return address;
}

#else

[[nodiscard]] void* loadSymbol(const std::filesystem::path& path, const char* symbol) {
    void* library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
    if (library == nullptr) {
        const char* reason = dlerror();
        refuse(path, std::string("cannot be loaded: ") + (reason != nullptr ? reason : "unknown reason"));
    }
    void* address = dlsym(library, symbol);
    if (address == nullptr) {
        dlclose(library);
        refuse(path, std::string("has no function ") + symbol);
    }
    return address;
}

#endif

}  // namespace

std::shared_ptr<const Runtime> Runtime::fromApiBase(const OrtApiBase* base) {
    return std::shared_ptr<const Runtime>(new Runtime(base));
}

std::shared_ptr<const Runtime> Runtime::open(const std::filesystem::path& library) {
    const auto getApiBase = reinterpret_cast<GetApiBase>(loadSymbol(library, "OrtGetApiBase"));
    return fromApiBase(getApiBase());
}

Runtime::Runtime(const OrtApiBase* base) {
    if (base == nullptr || base->GetApi == nullptr || base->GetVersionString == nullptr) {
        throw RuntimeUnavailable("ONNX Runtime's OrtGetApiBase returned nothing");
    }
    version_ = base->GetVersionString();
    apiVersion_ = apiOfVersion(version_);
    api_ = base->GetApi(apiVersion_);
    if (api_ == nullptr && apiVersion_ > minimumApi) {
        apiVersion_ = minimumApi;
        api_ = base->GetApi(apiVersion_);
    }
    if (api_ == nullptr) {
        throw RuntimeUnavailable("ONNX Runtime " + version_ + " is too old: 1.16 or newer is needed");
    }
    try {
        check(api_->CreateEnv(ORT_LOGGING_LEVEL_ERROR, "haptoflow", &environment_), "creating the environment");
        check(api_->DisableTelemetryEvents(environment_), "switching telemetry off");
    } catch (const InferenceError& error) {
        if (environment_ != nullptr) {
            api_->ReleaseEnv(environment_);
        }
        throw RuntimeUnavailable("ONNX Runtime " + version_ + ": " + error.what());
    }
}

Runtime::~Runtime() {
    api_->ReleaseEnv(environment_);
}

void Runtime::check(OrtStatus* status, std::string_view what) const {
    if (status == nullptr) {
        return;
    }
    const std::unique_ptr<OrtStatus, decltype(api_->ReleaseStatus)> owner(status, api_->ReleaseStatus);
    throw InferenceError(std::string(what) + ": " + api_->GetErrorMessage(status));
}

}  // namespace haptoflow::inference
