#include "inference/graph_session.hpp"
#include "inference/load_limits.hpp"
#include "inference/onnx_runtime.hpp"
#include "inference/onnx_session.hpp"
#include "model/model_error.hpp"

#include <onnxruntime_c_api.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace haptoflow::inference {
namespace {

// Memory limit of a session: a constant, an amount per request of the batch, and copies of the weights, which exist as
// read from the file, as tensors and packed for the processor.
constexpr std::size_t memoryOfAnyGraph = std::size_t{64} << 20U;
constexpr std::size_t memoryOfRequest = std::size_t{4} << 20U;
constexpr std::size_t copiesOfWeights = 4;

/// A session of the library ONNX Runtime.
class OnnxGraphSession final : public GraphSession {
public:
    OnnxGraphSession(std::shared_ptr<const Runtime> runtime, std::span<const std::byte> graph, std::string name,
                     GraphSignature signature, std::size_t maximumBatch, const LoadLimits& limits);

    void run() override { execute(nullptr, name_); }

private:
    void bind(std::size_t batch) override;
    void bind(const TensorSignature& tensor, std::size_t batch, std::vector<float>& buffer, bool isInput);
    /// Loads the graph and runs it once with maximumBatch_ requests within the limits.
    void probe(std::span<const std::byte> graph, const LoadLimits& limits);
    void execute(const OrtRunOptions* options, const std::string& what);

    std::shared_ptr<const Runtime> runtime_;
    OrtHandle<OrtMemoryInfo> memory_;
    OrtHandle<OrtSession> session_;
    OrtHandle<OrtIoBinding> binding_;
};

OnnxGraphSession::OnnxGraphSession(std::shared_ptr<const Runtime> runtime, std::span<const std::byte> graph,
                                   std::string name, GraphSignature signature, std::size_t maximumBatch,
                                   const LoadLimits& limits)
    : GraphSession(std::move(name), std::move(signature), maximumBatch),
      runtime_(std::move(runtime)),
      memory_(nullptr, nullptr),
      session_(nullptr, nullptr),
      binding_(nullptr, nullptr) {
    try {
        memory_ = createMemoryInfo(*runtime_);
        probe(graph, limits);
    } catch (const InferenceError& error) {
        throw model::ModelError(model::ModelStatus::inconsistent, name_ + ": " + error.what());
    }
}

void OnnxGraphSession::probe(std::span<const std::byte> graph, const LoadLimits& limits) {
    const OrtApi& api = runtime_->api();
    const std::size_t memoryBytes = memoryOfAnyGraph + memoryOfRequest * maximumBatch_ + copiesOfWeights * graph.size();
    session_ = createSession(*runtime_, graph, memoryBytes, limits);
    present_ = matchSignature(*runtime_, *session_, signature_, name_);
    binding_ = createBinding(*runtime_, *session_);
    setBatch(maximumBatch_);

    OrtRunOptions* created = nullptr;
    runtime_->check(api.CreateRunOptions(&created), "run options");
    const OrtHandle<OrtRunOptions> options(created, api.ReleaseRunOptions);
    const auto terminate = [&] {
        if (OrtStatus* status = api.RunOptionsSetTerminate(options.get())) {
            api.ReleaseStatus(status);
        }
    };
    const std::size_t parts = (maximumBatch_ + probeBatch - 1) / probeBatch;
    const double limitMs = limits.probeLimitMs * static_cast<double>(parts);
    const CancellationAction cancelled(limits.cancellation.get(), terminate);
    const TimeLimit limit(limitMs, terminate);
    const auto explain = [&] {
        limits.check();
        if (limit.hasPassed()) {
            throw TierTooSlow(name_ + ": a run of " + std::to_string(maximumBatch_) + " took longer than " +
                              std::to_string(static_cast<std::int64_t>(std::ceil(limitMs))) +
                              " ms; choose a smaller tier or model, or a higher probe_limit_ms");
        }
    };
    try {
        execute(options.get(), "a run of " + std::to_string(maximumBatch_) + " with at most " +
                                   std::to_string(memoryBytes >> 20U) + " MiB failed");
    } catch (const InferenceError&) {
        explain();
        throw;
    }
    explain();
}

void OnnxGraphSession::bind(const TensorSignature& tensor, std::size_t batch, std::vector<float>& buffer,
                            bool isInput) {
    const OrtApi& api = runtime_->api();
    std::vector<std::int64_t> shape{static_cast<std::int64_t>(batch)};
    shape.insert(shape.end(), tensor.shape.begin(), tensor.shape.end());
    OrtValue* created = nullptr;
    runtime_->check(
        api.CreateTensorWithDataAsOrtValue(memory_.get(), buffer.data(), tensor.size() * batch * sizeof(float),
                                           shape.data(), shape.size(), ONNX_TENSOR_ELEMENT_DATA_TYPE_FLOAT, &created),
        tensor.name);
    const OrtHandle<OrtValue> value(created, api.ReleaseValue);
    // The binding keeps its own reference to the value.
    runtime_->check(isInput ? api.BindInput(binding_.get(), tensor.name.c_str(), created)
                            : api.BindOutput(binding_.get(), tensor.name.c_str(), created),
                    tensor.name);
}

void OnnxGraphSession::bind(std::size_t batch) {
    runtime_->api().ClearBoundInputs(binding_.get());
    runtime_->api().ClearBoundOutputs(binding_.get());
    for (std::size_t index = 0; index < inputs_.size(); ++index) {
        if (present_[index]) {
            bind(signature_.inputs[index], batch, inputs_[index], true);
        }
    }
    bind(signature_.output, batch, output_, false);
}

void OnnxGraphSession::execute(const OrtRunOptions* options, const std::string& what) {
    runtime_->check(runtime_->api().RunWithBinding(session_.get(), options, binding_.get()), what);
}

}  // namespace

std::unique_ptr<GraphSession> loadGraphSession(std::shared_ptr<const Runtime> runtime, std::span<const std::byte> graph,
                                               std::string name, GraphSignature signature, std::size_t maximumBatch,
                                               const LoadLimits& limits) {
    return std::make_unique<OnnxGraphSession>(std::move(runtime), graph, std::move(name), std::move(signature),
                                              maximumBatch, limits);
}

}  // namespace haptoflow::inference
