#include "inference/onnx_runtime.hpp"

#include "inference/inference_error.hpp"
#include "inference/shared_library.hpp"

#include <onnxruntime_c_api.h>

namespace haptoflow::inference {
namespace {

// Everything used here exists since 1.16; asking for that version lets older libraries load, too.
constexpr std::uint32_t apiVersion = 16;

using GetApiBase = const OrtApiBase*(ORT_API_CALL*)();

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
    api_ = base->GetApi(apiVersion);
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
