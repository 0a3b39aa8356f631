#include "inference/graph_session.hpp"
#include "inference/load_limits.hpp"
#include "model/model_error.hpp"
#include "web_imports.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <utility>

namespace haptoflow::inference {
namespace {

constexpr int unfilledSize = -1;

/// What the page's ONNX Runtime said of its last failure.
std::string lastError() {
    std::array<char, 1024> text{};
    hapto_ort_error(text.data(), static_cast<int>(text.size()));
    return text.data();
}

/// A session of ONNX Runtime for the web, which has a memory of its own: tensors are copied in and out.
class WebGraphSession final : public GraphSession {
public:
    WebGraphSession(std::span<const std::byte> graph, std::string name, GraphSignature signature,
                    std::size_t maximumBatch, const LoadLimits& limits);
    WebGraphSession(const WebGraphSession&) = delete;
    WebGraphSession& operator=(const WebGraphSession&) = delete;
    ~WebGraphSession() override { hapto_ort_release(handle_); }

    void run() override {
        if (hapto_ort_run(handle_, tensors_.data(), static_cast<int>(tensors_.size())) != 0) {
            throw InferenceError(name_ + ": " + lastError());
        }
    }

private:
    void bind(std::size_t batch) override;
    void matchSignature();
    void probe(const LoadLimits& limits);
    [[noreturn]] void refuse(const std::string& complaint) const {
        throw model::ModelError(model::ModelStatus::inconsistent, name_ + ": " + complaint);
    }

    int handle_ = -1;
    /// The inputs that the graph has, then the output.
    std::vector<HaptoTensor> tensors_;
};

WebGraphSession::WebGraphSession(std::span<const std::byte> graph, std::string name, GraphSignature signature,
                                 std::size_t maximumBatch, const LoadLimits& limits)
    : GraphSession(std::move(name), std::move(signature), maximumBatch) {
    handle_ = hapto_ort_load(graph.data(), static_cast<int>(graph.size()));
    if (handle_ < 0) {
        refuse(lastError());
    }
    try {
        matchSignature();
        probe(limits);
    } catch (const InferenceError& error) {
        hapto_ort_release(handle_);
        throw model::ModelError(model::ModelStatus::inconsistent, error.what());
    } catch (...) {
        hapto_ort_release(handle_);
        throw;
    }
}

void WebGraphSession::matchSignature() {
    for (const TensorSignature& tensor : signature_.inputs) {
        present_.push_back(hapto_ort_has_input(handle_, tensor.name.c_str()) != 0);
    }
    const auto known = std::count(present_.begin(), present_.end(), true);
    if (known != hapto_ort_input_count(handle_)) {
        refuse("has an input that the format does not know");
    }
    if (hapto_ort_has_output(handle_, signature_.output.name.c_str()) == 0) {
        refuse("has no output \"" + signature_.output.name + '"');
    }
}

void WebGraphSession::probe(const LoadLimits& limits) {
    limits.check();
    setBatch(maximumBatch_);
    const auto began = std::chrono::steady_clock::now();
    run();
    const std::chrono::duration<double, std::milli> spent = std::chrono::steady_clock::now() - began;
    const std::size_t parts = (maximumBatch_ + probeBatch - 1) / probeBatch;
    const double limitMs = limits.probeLimitMs * static_cast<double>(parts);
    if (spent.count() > limitMs) {
        throw TierTooSlow(name_ + ": a run of " + std::to_string(maximumBatch_) + " took longer than " +
                          std::to_string(static_cast<std::int64_t>(std::ceil(limitMs))) +
                          " ms; choose a smaller tier or model");
    }
}

void WebGraphSession::bind(std::size_t batch) {
    tensors_.clear();
    const auto add = [this, batch](const TensorSignature& tensor, std::vector<float>& buffer) {
        HaptoTensor& bound = tensors_.emplace_back();
        bound.name = tensor.name.c_str();
        bound.data = buffer.data();
        bound.count = static_cast<std::int32_t>(tensor.size() * batch);
        bound.rank = static_cast<std::int32_t>(tensor.shape.size() + 1);
        if (tensor.shape.size() + 1 > bound.shape.size()) {
            refuse("\"" + tensor.name + "\" has too many dimensions");
        }
        bound.shape.fill(unfilledSize);
        bound.shape[0] = static_cast<std::int32_t>(batch);
        std::transform(tensor.shape.begin(), tensor.shape.end(), bound.shape.begin() + 1,
                       [](std::int64_t size) { return static_cast<std::int32_t>(size); });
    };
    for (std::size_t index = 0; index < inputs_.size(); ++index) {
        if (present_[index]) {
            add(signature_.inputs[index], inputs_[index]);
        }
    }
    add(signature_.output, output_);
}

}  // namespace

std::unique_ptr<GraphSession> loadGraphSession(std::shared_ptr<const Runtime> /*runtime*/,
                                               std::span<const std::byte> graph, std::string name,
                                               GraphSignature signature, std::size_t maximumBatch,
                                               const LoadLimits& limits) {
    return std::make_unique<WebGraphSession>(graph, std::move(name), std::move(signature), maximumBatch, limits);
}

}  // namespace haptoflow::inference
