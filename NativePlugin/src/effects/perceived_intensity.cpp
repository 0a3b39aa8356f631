#include "effects/perceived_intensity.hpp"

#include "dsp/fourier_transform.hpp"
#include "dsp/sample_rates.hpp"

#include <algorithm>
#include <array>
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
            const auto cycles = static_cast<double>(i * n % gridSize) / static_cast<double>(gridSize);
            sum += weight * logMagnitude[i] * std::cos(2.0 * std::numbers::pi * cycles);
        }
        folded[n] = (n == 0 ? 1.0 : 2.0) * sum / static_cast<double>(gridSize);
    }
    dsp::minimumPhaseResponse(folded, impulseResponse_);
    delaySamples_ = groupDelay(impulseResponse_, 125.0);
}

namespace {

struct Point {
    double frequencyHz;
    double value;
};

constexpr std::array<Point, 14> thresholds{{{1.0, 1.0},
                                            {10.0, 0.10},
                                            {20.0, 0.085},
                                            {40.0, 0.060},
                                            {80.0, 0.036},
                                            {125.0, 0.027},
                                            {160.0, 0.030},
                                            {200.0, 0.047},
                                            {250.0, 0.086},
                                            {320.0, 0.24},
                                            {400.0, 0.56},
                                            {500.0, 1.37},
                                            {800.0, 8.98},
                                            {1000.0, 21.9}}};

constexpr std::array<Point, 10> exponents{{{30.0, 1.44},
                                           {40.0, 1.23},
                                           {60.0, 1.00},
                                           {80.0, 0.88},
                                           {125.0, 0.75},
                                           {160.0, 0.73},
                                           {200.0, 0.77},
                                           {250.0, 0.83},
                                           {320.0, 1.00},
                                           {400.0, 1.20}}};

template <std::size_t count>
double interpolate(const std::array<Point, count>& table, double frequencyHz) noexcept {
    if (!(frequencyHz > table.front().frequencyHz)) {
        return table.front().value;
    }
    if (frequencyHz >= table.back().frequencyHz) {
        return table.back().value;
    }
    const auto above = std::ranges::upper_bound(table, frequencyHz, {}, &Point::frequencyHz);
    const Point& low = *(above - 1);
    const double share = std::log(frequencyHz / low.frequencyHz) / std::log(above->frequencyHz / low.frequencyHz);
    return low.value * std::pow(above->value / low.value, share);
}

}  // namespace

double detectionThresholdMps2(double frequencyHz) noexcept {
    return interpolate(thresholds, frequencyHz);
}

double intensityExponent(double frequencyHz) noexcept {
    return interpolate(exponents, frequencyHz);
}

double intensityOfRatio(double ratio, double exponent) noexcept {
    if (!(ratio > 0.0)) {
        return 0.0;
    }
    const double contourRatio = std::pow(contourIntensity, 1.0 / exponent);
    return ratio <= contourRatio ? std::pow(ratio, exponent)
                                 : contourIntensity * std::pow(ratio / contourRatio, exponentAboveContour);
}

double ratioOfIntensity(double intensity, double exponent) noexcept {
    if (!(intensity > 0.0)) {
        return 0.0;
    }
    const double below = std::pow(std::min(intensity, contourIntensity), 1.0 / exponent);
    return intensity <= contourIntensity ? below
                                         : below * std::pow(intensity / contourIntensity, 1.0 / exponentAboveContour);
}

double intensityOfSinusoid(double amplitudeMps2, double frequencyHz) noexcept {
    return intensityOfRatio(amplitudeMps2 / detectionThresholdMps2(frequencyHz), intensityExponent(frequencyHz));
}

double amplitudeOfIntensity(double intensity, double frequencyHz) noexcept {
    return detectionThresholdMps2(frequencyHz) * ratioOfIntensity(intensity, intensityExponent(frequencyHz));
}

}  // namespace haptoflow::effects
