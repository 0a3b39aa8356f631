#pragma once

#include <array>
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

/// Largest number of hidden units: the buffers of a run are on the stack.
inline constexpr std::size_t maximumHidden = 512;

/// A linear layer followed by SiLU, x / (1 + e^-x), twice: what all outputs of a perceptron have in common.
class HiddenLayers {
public:
    using Activations = std::array<float, maximumHidden>;

    /// The second layer takes the first one's outputs, at most maximumHidden.
    HiddenLayers(LinearLayer first, LinearLayer second);

    /// Returns the activations for inputs() numbers; the first outputs() are set. No allocation.
    [[nodiscard]] Activations run(std::span<const float> x) const noexcept;

    [[nodiscard]] std::size_t inputs() const noexcept { return first_.inputs(); }
    [[nodiscard]] std::size_t outputs() const noexcept { return second_.outputs(); }

private:
    LinearLayer first_;
    LinearLayer second_;
};

/// Hidden layers and a linear layer.
class Perceptron {
public:
    Perceptron(HiddenLayers hidden, LinearLayer last);

    /// Reads inputs() numbers and writes outputs(). No allocation.
    void run(std::span<const float> x, std::span<float> y) const noexcept;

    [[nodiscard]] std::size_t inputs() const noexcept { return hidden_.inputs(); }
    [[nodiscard]] std::size_t outputs() const noexcept { return last_.outputs(); }

private:
    HiddenLayers hidden_;
    LinearLayer last_;
};

}  // namespace haptoflow::skeleton
