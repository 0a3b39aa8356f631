#pragma once

#include <cstddef>
#include <cstdint>
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

}  // namespace haptoflow::inference
