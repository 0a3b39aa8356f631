#include "dsp/splice.hpp"

#include <algorithm>
#include <cmath>

namespace haptoflow::dsp {
namespace {

// Mean square of 1e-4 m/s^2, a hundredth of what a fingertip feels at its most sensitive.
constexpr double silentMeanSquare = 1e-8;

}  // namespace

double spliceCorrelation(std::span<const float> continuation, std::span<const float> successor) noexcept {
    const std::size_t count = std::min({continuation.size(), successor.size(), Splice::correlationSamples});
    double continuationEnergy = 0.0;
    double successorEnergy = 0.0;
    double product = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
        const double a = continuation[i];
        const double b = successor[i];
        continuationEnergy += a * a;
        successorEnergy += b * b;
        product += a * b;
    }
    const double silence = silentMeanSquare * static_cast<double>(count);
    if (!(continuationEnergy > silence && successorEnergy > silence)) {
        return 1.0;
    }
    const double correlation = product / std::sqrt(continuationEnergy * successorEnergy);
    // Written so that a NaN, from a non-finite sample, counts as uncorrelated.
    return correlation > 0.0 ? std::min(correlation, 1.0) : 0.0;
}

void Splice::begin(std::span<const float> continuation, std::span<const float> successor, std::size_t length) noexcept {
    length_ = std::min({length, maximumLength, continuation.size(), successor.size()});
    index_ = 0;
    correlation_ = length_ == 0 ? 1.0 : spliceCorrelation(continuation, successor);
}

float Splice::next(float continuation, float successor) noexcept {
    if (!active()) {
        return successor;
    }
    const double a = static_cast<double>(index_ + 1) / static_cast<double>(length_ + 1);
    ++index_;
    // The root's argument equals (1-a)^2 + a^2 + 2 a (1-a) rho, in a form that is exactly 1 at rho = 1; likewise the
    // sum is written around the difference, which is exactly 0 for identical samples.
    const double norm = std::sqrt(1.0 - 2.0 * a * (1.0 - a) * (1.0 - correlation_));
    const double difference = static_cast<double>(continuation) - static_cast<double>(successor);
    return static_cast<float>((static_cast<double>(successor) + (1.0 - a) * difference) / norm);
}

}  // namespace haptoflow::dsp
