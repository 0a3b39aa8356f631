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

enum class Optimisation {
    /// The graph as it stands: nothing is computed while it loads.
    none,
    /// Constants folded, operators fused.
    all,
};

[[nodiscard]] OrtHandle<OrtMemoryInfo> createMemoryInfo(const Runtime& runtime);
[[nodiscard]] OrtHandle<OrtIoBinding> createBinding(const Runtime& runtime, OrtSession& session);

/// A session of one thread whose tensors, weights included, take at most `memoryBytes`: what needs more fails, when it
/// loads or when it runs. Throws InferenceError, LoadCancelled.
[[nodiscard]] OrtHandle<OrtSession> createSession(const Runtime& runtime, std::span<const std::byte> graph,
                                                  Optimisation optimisation, std::size_t memoryBytes,
                                                  const LoadLimits& limits);

}  // namespace haptoflow::inference
