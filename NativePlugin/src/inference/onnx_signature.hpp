#pragma once

#include "inference/onnx_runtime.hpp"

#include <cstdint>
#include <string>
#include <vector>

struct OrtSession;

namespace haptoflow::inference {

/// A float32 tensor of a graph: its name and its dimensions behind the batch.
struct TensorSignature {
    std::string name;
    std::vector<std::int64_t> shape;

    /// Numbers in one element of the batch.
    [[nodiscard]] std::size_t size() const noexcept;
};

/// What the format expects of a graph: it may leave out inputs, but not have others.
struct GraphSignature {
    std::vector<TensorSignature> inputs;
    TensorSignature output;
};

/// Compares a session's inputs and outputs with `expected`: names, float32, the number of dimensions, a batch that is
/// free, and the dimensions behind it. Returns, for each expected input, whether the graph has it. Throws
/// model::ModelError (inconsistent) that begins with `graphName`.
[[nodiscard]] std::vector<bool> matchSignature(const Runtime& runtime, const OrtSession& session,
                                               const GraphSignature& expected, const std::string& graphName);

}  // namespace haptoflow::inference
