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

/// An ONNX graph with one output, ready to run on one thread. Its inputs and its output are buffers that stay where
/// they are: fill the inputs, run, read the output. One user at a time; `run` allocates inside ONNX Runtime.
class OnnxGraph {
public:
    /// Reads the graph's operators before ONNX Runtime does, loads it, compares it with `signature` and runs it with
    /// maximumBatch requests and with one. Throws model::ModelError (inconsistent) that begins with `name` where the
    /// graph is not what the format says, TierTooSlow, LoadCancelled.
    OnnxGraph(std::shared_ptr<const Runtime> runtime, std::span<const std::byte> graph, std::string name,
              GraphSignature signature, std::size_t maximumBatch, const LoadLimits& limits);

    /// Rebinds the buffers where `batch` (1 to maximumBatch) differs from the last one.
    void setBatch(std::size_t batch);

    /// Whether the graph reads the input at this position of the signature.
    [[nodiscard]] bool reads(std::size_t input) const { return present_.at(input); }
    /// The input at this position of the signature, batch * its size numbers. Writable even where the graph leaves
    /// the input out; it is then read by nobody.
    [[nodiscard]] std::span<float> input(std::size_t input);
    /// batch * the output's size numbers, valid after `run`.
    [[nodiscard]] std::span<const float> output() const noexcept;

    /// Throws InferenceError.
    void run();

    /// How often the graph has run since it was loaded; the run that proves it at loading is not counted.
    [[nodiscard]] std::uint64_t runs() const noexcept { return runs_; }

private:
    void bind(const TensorSignature& tensor, std::size_t batch, std::vector<float>& buffer, bool isInput);
    /// Loads the graph with the given optimisation and runs it once with so many requests, within the limits.
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
