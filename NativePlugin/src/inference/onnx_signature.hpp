#pragma once

#include "inference/onnx_runtime.hpp"

#include <cstdint>
#include <string>
#include <vector>

struct OrtSession;

namespace haptoflow::inference {

/// Name and dimensions of a float32 tensor of a graph, without the batch dimension.
struct TensorSignature {
    std::string name;
    std::vector<std::int64_t> shape;

    /// Numbers in one element of the batch.
    [[nodiscard]] std::size_t size() const noexcept;
};

/// The inputs and the output that the format defines for a graph. A graph may lack inputs but not have others.
struct GraphSignature {
    std::vector<TensorSignature> inputs;
    TensorSignature output;
};

/// Compares a session's inputs and outputs with `expected`: names, element type, number of dimensions, a variable batch
/// dimension, and the other dimensions. Returns, for each expected input, whether the graph has it. Throws
/// model::ModelError (inconsistent); the message begins with `graphName`.
[[nodiscard]] std::vector<bool> matchSignature(const Runtime& runtime, const OrtSession& session,
                                               const GraphSignature& expected, const std::string& graphName);

}  // namespace haptoflow::inference
