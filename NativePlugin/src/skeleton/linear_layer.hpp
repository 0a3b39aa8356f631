#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace haptoflow::skeleton {

/// y = W x + b. The weights lie in blocks of 16 and, at the end, of 4 outputs, each block input by input, so that a
/// block is read once from front to back while its sums stay in registers.
class LinearLayer {
public:
    /// `weight` is row-major, outputs x inputs, as PyTorch's nn.Linear has it; `bias` has a number for each output.
    LinearLayer(std::span<const float> weight, std::span<const float> bias);

    [[nodiscard]] std::size_t inputs() const noexcept { return inputs_; }
    [[nodiscard]] std::size_t outputs() const noexcept { return outputs_; }

    /// Reads inputs() numbers of `x` and writes outputs() numbers of `y`; the two must not overlap. No allocation.
    void apply(std::span<const float> x, std::span<float> y) const noexcept;

private:
    std::size_t inputs_;
    std::size_t outputs_;
    std::vector<float> blocks_;
    // Padded with zeros to whole blocks.
    std::vector<float> bias_;
};

}  // namespace haptoflow::skeleton
