#include "inference/load_limits.hpp"
#include "inference/onnx_runtime.hpp"

// ONNX Runtime for the web belongs to the worker's scripts: there is nothing to open, and one is as good as another.
namespace haptoflow::inference {

Runtime::Runtime(const OrtApiBase* /*base*/) : version_("onnxruntime-web") {}

Runtime::~Runtime() = default;

std::shared_ptr<const Runtime> Runtime::fromApiBase(const OrtApiBase* base) {
    return std::shared_ptr<const Runtime>(new Runtime(base));
}

std::shared_ptr<const Runtime> Runtime::open(const std::filesystem::path& /*library*/) {
    return fromApiBase(nullptr);
}

}  // namespace haptoflow::inference
