#pragma once

#include "inference/onnx_runtime.hpp"
#include "inference/onnx_signature.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

struct OrtIoBinding;
struct OrtMemoryInfo;
struct OrtSession;
struct OrtValue;

namespace haptoflow::inference {

template <typename Type>
using OrtHandle = std::unique_ptr<Type, void (*)(Type*)>;

/// An ONNX graph with one output, ready to run on one thread. Its inputs and its output are buffers that stay where
/// they are: fill the inputs, run, read the output. One user at a time; `run` allocates inside ONNX Runtime.
class OnnxGraph {
public:
    /// Loads the graph, compares it with `signature` and runs it once. Throws model::ModelError (inconsistent) that
    /// begins with `name` where the graph is not what the format says.
    OnnxGraph(std::shared_ptr<const Runtime> runtime, std::span<const std::byte> graph, std::string name,
              GraphSignature signature, std::size_t maximumBatch);

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
    void execute();

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
