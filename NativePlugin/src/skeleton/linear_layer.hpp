#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace haptoflow::skeleton {

/// y = W x + b. The weights of one input lie together, so that compilers turn the sums over the outputs into vector
/// operations.
class LinearLayer {
public:
    /// `weight` is row-major, outputs x inputs, as PyTorch's nn.Linear has it; `bias` has a number for each output.
    LinearLayer(std::span<const float> weight, std::span<const float> bias);

    [[nodiscard]] std::size_t inputs() const noexcept { return inputs_; }
    [[nodiscard]] std::size_t outputs() const noexcept { return bias_.size(); }

    /// Reads inputs() numbers of `x` and writes outputs() numbers of `y`; the two must not overlap. No allocation.
    void apply(std::span<const float> x, std::span<float> y) const noexcept;

private:
    std::size_t inputs_;
    // inputs x outputs.
    std::vector<float> weight_;
    std::vector<float> bias_;
};

}  // namespace haptoflow::skeleton
