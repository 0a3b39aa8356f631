#include "inference/onnx_graph.hpp"

#include "inference/inference_error.hpp"
#include "inference/time_limit.hpp"
#include "model/model_error.hpp"
#include "model/onnx_check.hpp"

#include <onnxruntime_c_api.h>

#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

namespace haptoflow::inference {
namespace {

// Memory limit of a session: a constant, an amount per request of the batch, and copies of the weights, which exist as
// read from the file, as tensors and packed for the processor.
constexpr std::size_t memoryOfAnyGraph = std::size_t{64} << 20U;
constexpr std::size_t memoryOfRequest = std::size_t{4} << 20U;
constexpr std::size_t copiesOfWeights = 4;

}  // namespace

OnnxGraph::OnnxGraph(std::shared_ptr<const Runtime> runtime, std::span<const std::byte> graph, std::string name,
                     GraphSignature signature, std::size_t maximumBatch, const LoadLimits& limits)
    : runtime_(std::move(runtime)),
      name_(std::move(name)),
      signature_(std::move(signature)),
      maximumBatch_(maximumBatch),
      memory_(nullptr, nullptr),
      session_(nullptr, nullptr),
      binding_(nullptr, nullptr) {
    limits.check();
    model::checkOnnxModel(graph, name_);
    try {
        memory_ = createMemoryInfo(*runtime_);
        for (const TensorSignature& tensor : signature_.inputs) {
            inputs_.emplace_back(tensor.size() * maximumBatch_);
        }
        output_.resize(signature_.output.size() * maximumBatch_);
        // First without optimisation, because a run can be limited in time and cancelled, and the folding of constants
        // while loading cannot.
        probe(graph, Optimisation::none, maximumBatch_, limits);
        probe(graph, Optimisation::all, 1, limits);
    } catch (const InferenceError& error) {
        throw model::ModelError(model::ModelStatus::inconsistent, name_ + ": " + error.what());
    }
}

void OnnxGraph::probe(std::span<const std::byte> graph, Optimisation optimisation, std::size_t batch,
                      const LoadLimits& limits) {
    const OrtApi& api = runtime_->api();
    const std::size_t memoryBytes = memoryOfAnyGraph + memoryOfRequest * maximumBatch_ + copiesOfWeights * graph.size();
    binding_.reset();
    // Release the old session before the new one takes as much memory.
    session_.reset();
    session_ = createSession(*runtime_, graph, optimisation, memoryBytes, limits);
    present_ = matchSignature(*runtime_, *session_, signature_, name_);
    binding_ = createBinding(*runtime_, *session_);
    batch_ = 0;
    setBatch(batch);

    OrtRunOptions* created = nullptr;
    runtime_->check(api.CreateRunOptions(&created), "run options");
    const OrtHandle<OrtRunOptions> options(created, api.ReleaseRunOptions);
    const auto terminate = [&] {
        if (OrtStatus* status = api.RunOptionsSetTerminate(options.get())) {
            api.ReleaseStatus(status);
        }
    };
    const double limitMs = limits.probeLimitMs * static_cast<double>((batch + probeBatch - 1) / probeBatch);
    const CancellationAction cancelled(limits.cancellation.get(), terminate);
    const TimeLimit limit(limitMs, terminate);
    const auto explain = [&] {
        limits.check();
        if (limit.hasPassed()) {
            throw TierTooSlow(name_ + ": a run of " + std::to_string(batch) + " took longer than " +
                              std::to_string(static_cast<std::int64_t>(std::ceil(limitMs))) +
                              " ms; choose a smaller tier or model, or a higher probe_limit_ms");
        }
    };
    try {
        execute(options.get(), "a run of " + std::to_string(batch) + " with at most " +
                                   std::to_string(memoryBytes >> 20U) + " MiB failed");
    } catch (const InferenceError&) {
        explain();
        throw;
    }
    explain();
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
    // The binding keeps its own reference to the value.
    runtime_->check(isInput ? api.BindInput(binding_.get(), tensor.name.c_str(), created)
                            : api.BindOutput(binding_.get(), tensor.name.c_str(), created),
                    tensor.name);
}

void OnnxGraph::setBatch(std::size_t batch) {
    if (batch < 1 || batch > maximumBatch_) {
        throw std::invalid_argument("the batch is " + std::to_string(batch) + "; expected 1 to " +
                                    std::to_string(maximumBatch_));
    }
    if (batch == batch_) {
        return;
    }
    // If binding throws, this stays 0, so that the next call binds everything again.
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
    execute(nullptr, name_);
    ++runs_;
}

void OnnxGraph::execute(const OrtRunOptions* options, const std::string& what) {
    runtime_->check(runtime_->api().RunWithBinding(session_.get(), options, binding_.get()), what);
}

}  // namespace haptoflow::inference
