#pragma once

#include "inference/load_limits.hpp"
#include "inference/onnx_runtime.hpp"
#include "inference/onnx_session.hpp"
#include "inference/onnx_signature.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

struct OrtRunOptions;
struct OrtValue;

namespace haptoflow::inference {

/// An ONNX graph with one output, ready to run on one thread. Fill the inputs, call `run`, read the output; the buffers
/// stay at the same addresses. Used by one thread at a time; ONNX Runtime allocates in `run`.
class OnnxGraph {
public:
    /// Checks the graph's operators, loads it, compares it with `signature` and runs it with maximumBatch requests and
    /// with one. Throws model::ModelError (inconsistent), whose message begins with `name`, if the graph does not match
    /// the format; TierTooSlow; LoadCancelled.
    OnnxGraph(std::shared_ptr<const Runtime> runtime, std::span<const std::byte> graph, std::string name,
              GraphSignature signature, std::size_t maximumBatch, const LoadLimits& limits);

    /// Sets the batch size, 1 to maximumBatch. Throws std::invalid_argument.
    void setBatch(std::size_t batch);

    /// Whether the graph has the input at this position of the signature.
    [[nodiscard]] bool hasInput(std::size_t input) const { return present_.at(input); }
    /// Buffer of the input at this position of the signature, batch * its size numbers. May be written even if the
    /// graph lacks the input, and then has no effect.
    [[nodiscard]] std::span<float> input(std::size_t input);
    /// batch * the output's size numbers, valid after `run`.
    [[nodiscard]] std::span<const float> output() const noexcept;

    /// Throws InferenceError.
    void run();

    /// Number of runs since loading; the probe runs are not counted.
    [[nodiscard]] std::uint64_t runs() const noexcept { return runs_; }

private:
    void bind(const TensorSignature& tensor, std::size_t batch, std::vector<float>& buffer, bool isInput);
    /// Loads the graph with the given optimisation and runs it once with `batch` requests within the limits.
    void probe(std::span<const std::byte> graph, Optimisation optimisation, std::size_t batch,
               const LoadLimits& limits);
    void execute(const OrtRunOptions* options, const std::string& what);

    std::shared_ptr<const Runtime> runtime_;
    std::string name_;
    GraphSignature signature_;
    std::size_t maximumBatch_;
    std::size_t batch_ = 0;
    std::uint64_t runs_ = 0;
    std::vector<bool> present_;
    std::vector<std::vector<float>> inputs_;
    std::vector<float> output_;
    OrtHandle<OrtMemoryInfo> memory_;
    OrtHandle<OrtSession> session_;
    OrtHandle<OrtIoBinding> binding_;
};

}  // namespace haptoflow::inference
