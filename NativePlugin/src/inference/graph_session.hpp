#pragma once

#include "inference/load_limits.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace haptoflow::inference {

/// Name and dimensions of a float32 tensor of a graph, without the batch dimension.
struct TensorSignature {
    std::string name;
    std::vector<std::int64_t> shape;

    friend bool operator==(const TensorSignature&, const TensorSignature&) = default;

    /// Numbers in one element of the batch.
    [[nodiscard]] std::size_t size() const noexcept {
        std::size_t product = 1;
        for (const std::int64_t dimension : shape) {
            product *= static_cast<std::size_t>(dimension);
        }
        return product;
    }
};

/// The inputs and the output that the format defines for a graph. A graph may lack inputs but not have others.
struct GraphSignature {
    std::vector<TensorSignature> inputs;
    TensorSignature output;

    friend bool operator==(const GraphSignature&, const GraphSignature&) = default;
};

class Runtime;

/// An ONNX graph with one output, loaded by what runs networks on this platform, and the buffers of its tensors. Fill
/// the inputs, call `run`, read the output; the buffers stay at the same addresses. Used by one thread at a time; ONNX
/// Runtime allocates in `run`.
class GraphSession {
public:
    GraphSession(const GraphSession&) = delete;
    GraphSession& operator=(const GraphSession&) = delete;
    virtual ~GraphSession() = default;

    /// Sets the batch size, 1 to maximumBatch. Throws std::invalid_argument.
    void setBatch(std::size_t batch);
    /// Whether the graph has the input at this position of the signature.
    [[nodiscard]] bool hasInput(std::size_t input) const { return present_.at(input); }
    /// Buffer of the input at this position of the signature, one row for each member of the batch. It may be written
    /// even if the graph lacks the input, and then has no effect.
    [[nodiscard]] std::span<float> input(std::size_t input);
    /// What the last `run` computed, one row for each member of the batch.
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

/// The graphs that the tiers of one engine have loaded, so that tiers of the same graph load it once. One thread at a
/// time runs the generators that share a graph, and each fills its inputs before every run, since another one may have
/// written to them. The owner lets one thread at a time call this class.
class SharedSessions {
public:
    /// The session in use of this blob, signature and batch, or what `load` returns.
    template <typename Load>
    [[nodiscard]] std::shared_ptr<GraphSession> getOrLoad(const std::string& blob, const GraphSignature& signature,
                                                          std::size_t maximumBatch, Load load) {
        for (const Entry& entry : entries_) {
            if (entry.blob == blob && entry.maximumBatch == maximumBatch && entry.signature == signature) {
                if (auto session = entry.session.lock()) {
                    return session;
                }
            }
        }
        std::shared_ptr<GraphSession> session = load();
        entries_.push_back({blob, signature, maximumBatch, session});
        return session;
    }

    /// How many sessions were loaded.
    [[nodiscard]] std::size_t loaded() const noexcept { return entries_.size(); }

private:
    struct Entry {
        std::string blob;
        GraphSignature signature;
        std::size_t maximumBatch;
        /// Ends with the last generator.
        std::weak_ptr<GraphSession> session;
    };
    std::vector<Entry> entries_;
};

}  // namespace haptoflow::inference
