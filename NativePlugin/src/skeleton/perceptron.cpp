#include "skeleton/perceptron.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace haptoflow::skeleton {
namespace {

// A segment every 14 ms finds the weights outside the processor's nearest caches. Requested this far ahead, they arrive
// in time; without, waiting for them takes three times as long as the arithmetic.
constexpr std::size_t floatsAhead = 1024;
constexpr std::size_t floatsPerLine = 16;

void request([[maybe_unused]] const float* first, [[maybe_unused]] std::size_t count) noexcept {
#if defined(__GNUC__)
    for (std::size_t i = 0; i < count; i += floatsPerLine) {
        __builtin_prefetch(first + i);
    }
#endif
}

/// Adds the contributions of two inputs, whose weights follow each other, to `count` sums.
void addPair(const float* x, const float* weight, float* __restrict sums, std::size_t count) noexcept {
    for (std::size_t i = 0; i < count; ++i) {
        sums[i] += x[0] * weight[i] + x[1] * weight[count + i];
    }
}

void addOne(float x, const float* weight, float* __restrict sums, std::size_t count) noexcept {
    for (std::size_t i = 0; i < count; ++i) {
        sums[i] += x * weight[i];
    }
}

void silu(std::span<float> values) noexcept {
    for (float& value : values) {
        value /= 1.0F + std::exp(-value);
    }
}

}  // namespace

LinearLayer::LinearLayer(std::span<const float> weight, std::span<const float> bias)
    : inputs_(weight.size() / bias.size()), weight_(weight.size()), bias_(bias.begin(), bias.end()) {
    for (std::size_t output = 0; output < outputs(); ++output) {
        for (std::size_t input = 0; input < inputs_; ++input) {
            weight_[input * outputs() + output] = weight[output * inputs_ + input];
        }
    }
}

void LinearLayer::apply(std::span<const float> x, std::span<float> y) const noexcept {
    const std::size_t count = outputs();
    std::ranges::copy(bias_, y.begin());
    const float* weight = weight_.data();
    const float* end = weight + weight_.size();
    request(weight, std::min(floatsAhead, weight_.size()));
    std::size_t input = 0;
    for (; input + 2 <= inputs_; input += 2, weight += 2 * count) {
        const auto left = static_cast<std::size_t>(end - weight);
        request(weight + std::min(floatsAhead, left), std::min(2 * count, left - std::min(floatsAhead, left)));
        addPair(x.data() + input, weight, y.data(), count);
    }
    if (input < inputs_) {
        addOne(x[input], weight, y.data(), count);
    }
}

HiddenLayers::HiddenLayers(LinearLayer first, LinearLayer second)
    : first_(std::move(first)), second_(std::move(second)) {}

HiddenLayers::Activations HiddenLayers::run(std::span<const float> x) const noexcept {
    Activations between;
    const auto hidden = std::span(between).first(first_.outputs());
    first_.apply(x, hidden);
    silu(hidden);
    Activations activations;
    const auto result = std::span(activations).first(second_.outputs());
    second_.apply(hidden, result);
    silu(result);
    return activations;
}

Perceptron::Perceptron(HiddenLayers hidden, LinearLayer last) : hidden_(std::move(hidden)), last_(std::move(last)) {}

void Perceptron::run(std::span<const float> x, std::span<float> y) const noexcept {
    const HiddenLayers::Activations activations = hidden_.run(x);
    last_.apply(activations, y);
}

}  // namespace haptoflow::skeleton
