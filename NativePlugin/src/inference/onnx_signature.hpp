#pragma once

#include "inference/graph_signature.hpp"
#include "inference/onnx_runtime.hpp"

#include <string>
#include <vector>

struct OrtSession;

namespace haptoflow::inference {

/// Compares a session's inputs and outputs with `expected`: names, element type, number of dimensions, a variable batch
/// dimension, and the other dimensions. Returns, for each expected input, whether the graph has it. Throws
/// model::ModelError (inconsistent); the message begins with `graphName`.
[[nodiscard]] std::vector<bool> matchSignature(const Runtime& runtime, const OrtSession& session,
                                               const GraphSignature& expected, const std::string& graphName);

}  // namespace haptoflow::inference
