#pragma once

#include "inference/graph_session.hpp"
#include "inference/load_limits.hpp"
#include "inference/onnx_runtime.hpp"

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <thread>
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

/// Compares a session's inputs and outputs with `expected`: names, element type, number of dimensions, a variable batch
/// dimension, and the other dimensions. Returns, for each expected input, whether the graph has it. Throws
/// model::ModelError (inconsistent); the message begins with `graphName`.
[[nodiscard]] std::vector<bool> matchSignature(const Runtime& runtime, const OrtSession& session,
                                               const GraphSignature& expected, const std::string& graphName);

/// Runs an action on its own thread once a time has passed, unless it was destroyed before. For loading only, because
/// it starts a thread.
class TimeLimit {
public:
    /// The action must neither block nor throw. Throws std::system_error.
    TimeLimit(double milliseconds, std::function<void()> action);
    TimeLimit(const TimeLimit&) = delete;
    TimeLimit& operator=(const TimeLimit&) = delete;
    /// Waits for a running action. Afterwards the action never runs.
    ~TimeLimit();

    /// By the clock: on a busy machine the thread may not have run yet.
    [[nodiscard]] bool hasPassed() const { return std::chrono::steady_clock::now() >= end_; }

private:
    std::chrono::steady_clock::time_point end_;
    std::mutex mutex_;
    std::condition_variable changed_;
    bool isOver_ = false;
    std::thread timer_;
};

}  // namespace haptoflow::inference
