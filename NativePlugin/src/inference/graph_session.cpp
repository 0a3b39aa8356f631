#include "inference/graph_session.hpp"

#include <stdexcept>
#include <utility>

namespace haptoflow::inference {

GraphSession::GraphSession(std::string name, GraphSignature signature, std::size_t maximumBatch)
    : name_(std::move(name)), signature_(std::move(signature)), maximumBatch_(maximumBatch) {
    for (const TensorSignature& tensor : signature_.inputs) {
        inputs_.emplace_back(tensor.size() * maximumBatch_);
    }
    output_.resize(signature_.output.size() * maximumBatch_);
}

void GraphSession::setBatch(std::size_t batch) {
    if (batch < 1 || batch > maximumBatch_) {
        throw std::invalid_argument("the batch is " + std::to_string(batch) + "; expected 1 to " +
                                    std::to_string(maximumBatch_));
    }
    if (batch == batch_) {
        return;
    }
    // If binding throws, this stays 0, so that the next call binds everything again.
    batch_ = 0;
    bind(batch);
    batch_ = batch;
}

std::span<float> GraphSession::input(std::size_t input) {
    return std::span(inputs_.at(input)).first(signature_.inputs[input].size() * batch_);
}

std::span<const float> GraphSession::output() const noexcept {
    return std::span(output_).first(signature_.output.size() * batch_);
}

}  // namespace haptoflow::inference
