#include "inference/onnx_graph.hpp"

#include "inference/inference_error.hpp"
#include "model/model_error.hpp"

#include <onnxruntime_c_api.h>

#include <stdexcept>
#include <utility>

namespace haptoflow::inference {
namespace {

OrtHandle<OrtSession> createSession(const Runtime& runtime, std::span<const std::byte> graph) {
    const OrtApi& api = runtime.api();
    OrtSessionOptions* created = nullptr;
    runtime.check(api.CreateSessionOptions(&created), "session options");
    const OrtHandle<OrtSessionOptions> options(created, api.ReleaseSessionOptions);
    // A voice's update is far shorter than waking a second thread, and a spinning pool would burn a core.
    runtime.check(api.SetIntraOpNumThreads(created, 1), "session options");
    runtime.check(api.SetInterOpNumThreads(created, 1), "session options");
    runtime.check(api.AddSessionConfigEntry(created, "session.intra_op.allow_spinning", "0"), "session options");
    runtime.check(api.AddSessionConfigEntry(created, "session.inter_op.allow_spinning", "0"), "session options");
    runtime.check(api.SetSessionGraphOptimizationLevel(created, ORT_ENABLE_ALL), "session options");

    OrtSession* session = nullptr;
    runtime.check(api.CreateSessionFromArray(&runtime.environment(), graph.data(), graph.size(), created, &session),
                  "loading the graph");
    return {session, api.ReleaseSession};
}

OrtHandle<OrtMemoryInfo> createMemoryInfo(const Runtime& runtime) {
    OrtMemoryInfo* memory = nullptr;
    runtime.check(runtime.api().CreateCpuMemoryInfo(OrtArenaAllocator, OrtMemTypeDefault, &memory), "memory info");
    return {memory, runtime.api().ReleaseMemoryInfo};
}

OrtHandle<OrtIoBinding> createBinding(const Runtime& runtime, OrtSession& session) {
    OrtIoBinding* binding = nullptr;
    runtime.check(runtime.api().CreateIoBinding(&session, &binding), "binding");
    return {binding, runtime.api().ReleaseIoBinding};
}

}  // namespace

OnnxGraph::OnnxGraph(std::shared_ptr<const Runtime> runtime, std::span<const std::byte> graph, std::string name,
                     GraphSignature signature, std::size_t maximumBatch)
    : runtime_(std::move(runtime)),
      name_(std::move(name)),
      signature_(std::move(signature)),
      maximumBatch_(maximumBatch),
      memory_(nullptr, nullptr),
      session_(nullptr, nullptr),
      binding_(nullptr, nullptr) {
    try {
        memory_ = createMemoryInfo(*runtime_);
        session_ = createSession(*runtime_, graph);
        present_ = matchSignature(*runtime_, *session_, signature_, name_);
        binding_ = createBinding(*runtime_, *session_);
        for (const TensorSignature& tensor : signature_.inputs) {
            inputs_.emplace_back(tensor.size() * maximumBatch_);
        }
        output_.resize(signature_.output.size() * maximumBatch_);
        setBatch(1);
        execute();
    } catch (const InferenceError& error) {
        throw model::ModelError(model::ModelStatus::inconsistent, name_ + ": " + error.what());
    }
}

void OnnxGraph::bind(const TensorSignature& tensor, std::size_t batch, std::vector<float>& buffer, bool isInput) {
    const OrtApi& api = runtime_->api();
    std::vector<std::int64_t> shape{static_cast<std::int64_t>(batch)};
    shape.insert(shape.end(), tensor.shape.begin(), tensor.shape.end());
    OrtValue* created = nullptr;
    runtime_->check(
        api.CreateTensorWithDataAsOrtValue(memory_.get(), buffer.data(), tensor.size() * batch * sizeof(float),
                                           shape.data(), shape.size(), ONNX_TENSOR_ELEMENT_DATA_TYPE_FLOAT, &created),
        tensor.name);
    const OrtHandle<OrtValue> value(created, api.ReleaseValue);
    // The binding holds a reference of its own.
    runtime_->check(isInput ? api.BindInput(binding_.get(), tensor.name.c_str(), created)
                            : api.BindOutput(binding_.get(), tensor.name.c_str(), created),
                    tensor.name);
}

void OnnxGraph::setBatch(std::size_t batch) {
    if (batch < 1 || batch > maximumBatch_) {
        throw std::invalid_argument("a batch of 1 to " + std::to_string(maximumBatch_) + ", not " +
                                    std::to_string(batch));
    }
    if (batch == batch_) {
        return;
    }
    // Stays 0 when binding fails half way, so that the next call binds everything again.
    batch_ = 0;
    runtime_->api().ClearBoundInputs(binding_.get());
    runtime_->api().ClearBoundOutputs(binding_.get());
    for (std::size_t index = 0; index < inputs_.size(); ++index) {
        if (present_[index]) {
            bind(signature_.inputs[index], batch, inputs_[index], true);
        }
    }
    bind(signature_.output, batch, output_, false);
    batch_ = batch;
}

std::span<float> OnnxGraph::input(std::size_t input) {
    return std::span(inputs_.at(input)).first(signature_.inputs[input].size() * batch_);
}

std::span<const float> OnnxGraph::output() const noexcept {
    return std::span(output_).first(signature_.output.size() * batch_);
}

void OnnxGraph::run() {
    execute();
    ++runs_;
}

void OnnxGraph::execute() {
    runtime_->check(runtime_->api().RunWithBinding(session_.get(), nullptr, binding_.get()), name_);
}

}  // namespace haptoflow::inference
