#pragma once

#include "inference/graph_session.hpp"
#include "inference/load_limits.hpp"
#include "inference/onnx_runtime.hpp"

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

struct OrtIoBinding;
struct OrtMemoryInfo;
struct OrtSession;

namespace haptoflow::inference {

template <typename Type>
using OrtHandle = std::unique_ptr<Type, void (*)(Type*)>;

[[nodiscard]] OrtHandle<OrtMemoryInfo> createMemoryInfo(const Runtime& runtime);
[[nodiscard]] OrtHandle<OrtIoBinding> createBinding(const Runtime& runtime, OrtSession& session);

/// A session with one thread whose tensors, weights included, take at most `memoryBytes`. A graph that needs more fails
/// while loading or running. Throws InferenceError, LoadCancelled.
[[nodiscard]] OrtHandle<OrtSession> createSession(const Runtime& runtime, std::span<const std::byte> graph,
                                                  std::size_t memoryBytes, const LoadLimits& limits);

}  // namespace haptoflow::inference

struct OrtSession;

namespace haptoflow::inference {

/// Compares a session's inputs and outputs with `expected`: names, element type, number of dimensions, a variable batch
/// dimension, and the other dimensions. Returns, for each expected input, whether the graph has it. Throws
/// model::ModelError (inconsistent); the message begins with `graphName`.
[[nodiscard]] std::vector<bool> matchSignature(const Runtime& runtime, const OrtSession& session,
                                               const GraphSignature& expected, const std::string& graphName);

}  // namespace haptoflow::inference
