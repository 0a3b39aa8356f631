#include "effects/threshold_filter.hpp"

#include "dsp/sample_rates.hpp"
#include "effects/perceived_intensity.hpp"

#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

namespace haptoflow::effects {
namespace {

using dsp::waveformRateHz;

// Large enough to avoid aliasing in the cepstrum of a curve that spans 60 dB.
constexpr std::size_t gridSize = 1024;

double groupDelay(std::span<const double> impulseResponse, double frequencyHz) {
    std::complex<double> sum = 0.0;
    std::complex<double> moment = 0.0;
    for (std::size_t i = 0; i < impulseResponse.size(); ++i) {
        const double angle = -2.0 * std::numbers::pi * frequencyHz / waveformRateHz * static_cast<double>(i);
        const std::complex<double> term = impulseResponse[i] * std::polar(1.0, angle);
        sum += term;
        moment += static_cast<double>(i) * term;
    }
    return (moment / sum).real();
}

}  // namespace

const ThresholdFilter& ThresholdFilter::shared() {
    static const ThresholdFilter filter;
    return filter;
}

// Folding the cepstrum of log |H| onto positive time gives the cepstrum c' of the minimum-phase response with the same
// magnitude. The response follows from n h(n) = sum k c'(k) h(n - k).
ThresholdFilter::ThresholdFilter() {
    std::vector<double> logMagnitude(gridSize / 2 + 1);
    for (std::size_t i = 0; i < logMagnitude.size(); ++i) {
        const double frequencyHz = waveformRateHz * static_cast<double>(i) / static_cast<double>(gridSize);
        logMagnitude[i] = -std::log(detectionThresholdMps2(frequencyHz));
    }
    std::array<double, taps> folded{};
    for (std::size_t n = 0; n < taps; ++n) {
        double sum = 0.0;
        for (std::size_t i = 0; i < logMagnitude.size(); ++i) {
            const double weight = i == 0 || i == gridSize / 2 ? 1.0 : 2.0;
            const auto turns = static_cast<double>(i * n % gridSize) / static_cast<double>(gridSize);
            sum += weight * logMagnitude[i] * std::cos(2.0 * std::numbers::pi * turns);
        }
        folded[n] = (n == 0 ? 1.0 : 2.0) * sum / static_cast<double>(gridSize);
    }
    impulseResponse_[0] = std::exp(folded[0]);
    for (std::size_t n = 1; n < taps; ++n) {
        double sum = 0.0;
        for (std::size_t k = 1; k <= n; ++k) {
            sum += static_cast<double>(k) * folded[k] * impulseResponse_[n - k];
        }
        impulseResponse_[n] = sum / static_cast<double>(n);
    }
    delaySamples_ = groupDelay(impulseResponse_, 125.0);
}

}  // namespace haptoflow::effects
