#include "skeleton/perceptron.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace haptoflow::skeleton {
namespace {

void silu(std::span<float> values) noexcept {
    for (float& value : values) {
        value /= 1.0F + std::exp(-value);
    }
}

}  // namespace

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
