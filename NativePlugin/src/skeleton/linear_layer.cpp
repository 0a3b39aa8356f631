#include "skeleton/linear_layer.hpp"

#include <algorithm>
#include <array>

namespace haptoflow::skeleton {
namespace {

constexpr std::size_t wideBlock = 16;
constexpr std::size_t narrowBlock = 4;

/// Calls `action(first output, width)` for each block.
template <typename Action>
void forEachBlock(std::size_t outputs, Action action) {
    std::size_t first = 0;
    for (; first + wideBlock <= outputs; first += wideBlock) {
        action(first, wideBlock);
    }
    for (; first < outputs; first += narrowBlock) {
        action(first, narrowBlock);
    }
}

template <std::size_t Width>
std::array<float, Width> sumsOf(const float* weights, std::span<const float> x, const float* bias) noexcept {
    std::array<float, Width> sums{};
    for (std::size_t output = 0; output < Width; ++output) {
        sums[output] = bias[output];
    }
    for (const float value : x) {
        for (std::size_t output = 0; output < Width; ++output) {
            sums[output] += value * weights[output];
        }
        weights += Width;
    }
    return sums;
}

}  // namespace

LinearLayer::LinearLayer(std::span<const float> weight, std::span<const float> bias)
    : inputs_(weight.size() / bias.size()), outputs_(bias.size()) {
    forEachBlock(outputs_, [&](std::size_t first, std::size_t width) {
        const auto rowAt = [&](std::size_t input, std::size_t output) {
            return output < outputs_ ? weight[output * inputs_ + input] : 0.0F;
        };
        for (std::size_t input = 0; input < inputs_; ++input) {
            for (std::size_t output = first; output < first + width; ++output) {
                blocks_.push_back(rowAt(input, output));
            }
        }
        for (std::size_t output = first; output < first + width; ++output) {
            bias_.push_back(output < outputs_ ? bias[output] : 0.0F);
        }
    });
}

void LinearLayer::apply(std::span<const float> x, std::span<float> y) const noexcept {
    const auto read = x.first(inputs_);
    forEachBlock(outputs_, [&](std::size_t first, std::size_t width) {
        const float* weights = blocks_.data() + first * inputs_;
        const float* bias = bias_.data() + first;
        if (width == wideBlock) {
            const auto sums = sumsOf<wideBlock>(weights, read, bias);
            std::ranges::copy(sums, y.subspan(first).begin());
        } else {
            const auto sums = sumsOf<narrowBlock>(weights, read, bias);
            const std::size_t kept = std::min(narrowBlock, outputs_ - first);
            std::copy_n(sums.begin(), kept, y.subspan(first).begin());
        }
    });
}

}  // namespace haptoflow::skeleton
