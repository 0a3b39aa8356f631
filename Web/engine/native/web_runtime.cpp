#include "inference/load_limits.hpp"
#include "inference/onnx_runtime.hpp"

#include <utility>

// ONNX Runtime for the web belongs to the worker's scripts: there is nothing to open, and one is as good as another.
namespace haptoflow::inference {

Runtime::Runtime(const OrtApiBase* /*base*/, std::shared_ptr<LogSink> log)
    : version_("onnxruntime-web"), log_(std::move(log)) {}

Runtime::~Runtime() = default;

std::shared_ptr<const Runtime> Runtime::fromApiBase(const OrtApiBase* base, std::shared_ptr<LogSink> log) {
    return std::shared_ptr<const Runtime>(new Runtime(base, std::move(log)));
}

std::shared_ptr<const Runtime> Runtime::open(const std::filesystem::path& /*library*/, std::shared_ptr<LogSink> log) {
    return fromApiBase(nullptr, std::move(log));
}

}  // namespace haptoflow::inference
