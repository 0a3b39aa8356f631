#pragma once

#include "inference/load_limits.hpp"
#include "inference/onnx_runtime.hpp"

#include <cstddef>
#include <memory>
#include <span>

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
