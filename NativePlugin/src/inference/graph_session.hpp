#pragma once

#include "inference/graph_signature.hpp"
#include "inference/load_limits.hpp"

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace haptoflow::inference {

class Runtime;

/// A graph loaded by what runs networks on this platform, and the buffers of its tensors. Used by one thread at a time.
class GraphSession {
public:
    GraphSession(const GraphSession&) = delete;
    GraphSession& operator=(const GraphSession&) = delete;
    virtual ~GraphSession() = default;

    /// Sets the batch size, 1 to maximumBatch. Throws std::invalid_argument.
    void setBatch(std::size_t batch);
    [[nodiscard]] bool hasInput(std::size_t input) const { return present_.at(input); }
    [[nodiscard]] std::span<float> input(std::size_t input);
    [[nodiscard]] std::span<const float> output() const noexcept;
    /// Throws InferenceError.
    virtual void run() = 0;

protected:
    GraphSession(std::string name, GraphSignature signature, std::size_t maximumBatch);

    /// Prepares runs of `batch` requests on the buffers.
    virtual void bind(std::size_t batch) = 0;

    // NOLINTBEGIN(cppcoreguidelines-non-private-member-variables-in-classes,readability-identifier-naming)
    const std::string name_;
    const GraphSignature signature_;
    const std::size_t maximumBatch_;
    std::size_t batch_ = 0;
    /// For each input of the signature, whether the graph has it.
    std::vector<bool> present_;
    /// maximumBatch times the size of each tensor; they stay at the same addresses.
    std::vector<std::vector<float>> inputs_;
    std::vector<float> output_;
    // NOLINTEND(cppcoreguidelines-non-private-member-variables-in-classes,readability-identifier-naming)
};

/// Loads a graph whose operators were checked, compares it with `signature` and runs it once with maximumBatch
/// requests. The linker takes one of two implementations: onnx_graph_session.cpp for the library ONNX Runtime, that of
/// Web/engine for ONNX Runtime for the web. Throws model::ModelError (inconsistent), whose message begins with `name`;
/// TierTooSlow; LoadCancelled.
[[nodiscard]] std::unique_ptr<GraphSession> loadGraphSession(std::shared_ptr<const Runtime> runtime,
                                                             std::span<const std::byte> graph, std::string name,
                                                             GraphSignature signature, std::size_t maximumBatch,
                                                             const LoadLimits& limits);

}  // namespace haptoflow::inference
