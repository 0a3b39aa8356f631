#pragma once

#include "inference/graph_session.hpp"
#include "inference/graph_signature.hpp"
#include "inference/load_limits.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>

namespace haptoflow::inference {

/// An ONNX graph with one output, ready to run on one thread. Fill the inputs, call `run`, read the output; the buffers
/// stay at the same addresses. Used by one thread at a time; ONNX Runtime allocates in `run`.
class OnnxGraph {
public:
    /// Checks the graph's operators, loads it, compares it with `signature` and runs it once with maximumBatch
    /// requests. Throws model::ModelError (inconsistent), whose message begins with `name`, if the graph does not match
    /// the format; TierTooSlow; LoadCancelled.
    OnnxGraph(std::shared_ptr<const Runtime> runtime, std::span<const std::byte> graph, std::string name,
              GraphSignature signature, std::size_t maximumBatch, const LoadLimits& limits);
    /// Runs a session that others use too, on the same thread.
    explicit OnnxGraph(std::shared_ptr<GraphSession> session) : session_(std::move(session)) {}

    /// What the first constructor loads. Throws the same.
    [[nodiscard]] static std::shared_ptr<GraphSession> loadChecked(std::shared_ptr<const Runtime> runtime,
                                                                   std::span<const std::byte> graph, std::string name,
                                                                   GraphSignature signature, std::size_t maximumBatch,
                                                                   const LoadLimits& limits);

    /// Sets the batch size, 1 to maximumBatch. Throws std::invalid_argument.
    void setBatch(std::size_t batch) { session_->setBatch(batch); }

    /// Whether the graph has the input at this position of the signature.
    [[nodiscard]] bool hasInput(std::size_t input) const { return session_->hasInput(input); }
    /// Buffer of the input at this position of the signature, batch * its size numbers. May be written even if the
    /// graph lacks the input, and then has no effect.
    [[nodiscard]] std::span<float> input(std::size_t input) { return session_->input(input); }
    /// batch * the output's size numbers, valid after `run`.
    [[nodiscard]] std::span<const float> output() const noexcept { return session_->output(); }

    /// Throws InferenceError.
    void run() {
        session_->run();
        ++runs_;
    }

    /// Number of runs since loading; the probe runs are not counted.
    [[nodiscard]] std::uint64_t runs() const noexcept { return runs_; }

private:
    std::shared_ptr<GraphSession> session_;
    std::uint64_t runs_ = 0;
};

}  // namespace haptoflow::inference
