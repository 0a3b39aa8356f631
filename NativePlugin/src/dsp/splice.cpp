#include "dsp/splice.hpp"

#include <algorithm>
#include <cmath>

namespace haptoflow::dsp {
namespace {

// Mean square of an amplitude of 1e-4 m/s^2, a hundredth of a fingertip's lowest detection threshold.
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
    // In this form a NaN, which a non-finite sample causes, counts as uncorrelated.
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
    // The argument of the root equals (1-a)^2 + a^2 + 2 a (1-a) rho, written so that it is exactly 1 at rho = 1. The
    // sum uses the difference because that is exactly 0 for identical samples.
    const double norm = std::sqrt(1.0 - 2.0 * a * (1.0 - a) * (1.0 - correlation_));
    const double difference = static_cast<double>(continuation) - static_cast<double>(successor);
    return static_cast<float>((static_cast<double>(successor) + (1.0 - a) * difference) / norm);
}

}  // namespace haptoflow::dsp
