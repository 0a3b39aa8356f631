#include "skeleton/reflection_filter.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace haptoflow::skeleton {
namespace {

/// tanh of it is .999.
constexpr double largestReflection = 3.8;
/// 50 dB as a natural logarithm.
constexpr double largestResonance = 2.5 * std::numbers::ln10;
// The longest response falls to 1/e in 33 ms, a resonance 10 Hz wide. A sharper one would be a line, which the waves
// make.
constexpr double poleRadius = 0.985;
// The newest samples stay in registers: a vector that is read right after its parts were written waits for them.
constexpr std::size_t newest = 4;

double logCosh(double x) noexcept {
    const double magnitude = std::fabs(x);
    return magnitude + std::log1p(std::exp(-2.0 * magnitude)) - std::numbers::ln2;
}

/// What predicts a sample from 0 to 24 samples before it, and how far it then still varies.
struct StepDown {
    /// Row m: the m coefficients.
    std::array<std::array<double, filterOrder>, filterOrder + 1> predictors{};
    std::array<double, filterOrder + 1> variances{};

    explicit StepDown(const ReflectionFilter& filter) noexcept {
        predictors[filterOrder] = filter.coefficients;
        variances[filterOrder] = std::exp(2.0 * filter.logGain);
        for (std::size_t m = filterOrder; m > 0; --m) {
            const auto& a = predictors[m];
            const double k = a[m - 1];
            // Rounding may carry a reflection of a very sharp filter to 1.
            const double rest = std::max(1.0 - k * k, 1e-9);
            variances[m - 1] = variances[m] / rest;
            for (std::size_t i = 0; i + 1 < m; ++i) {
                predictors[m - 1][i] = (a[i] - k * a[m - 2 - i]) / rest;
            }
        }
    }
};

}  // namespace

ReflectionFilter ReflectionFilter::of(std::span<const float, filterOrder> reflections, float gain) noexcept {
    std::array<double, filterOrder> limited{};
    double resonance = 0.0;
    for (std::size_t i = 0; i < filterOrder; ++i) {
        limited[i] = std::clamp(static_cast<double>(reflections[i]), -largestReflection, largestReflection);
        resonance += logCosh(limited[i]);
    }
    const double share = resonance > largestResonance ? largestResonance / resonance : 1.0;

    ReflectionFilter filter;
    auto& a = filter.coefficients;
    filter.logGain = 2.0 * std::tanh(0.5 * static_cast<double>(gain));
    std::array<double, filterOrder> before{};
    for (std::size_t m = 0; m < filterOrder; ++m) {
        const double scaled = limited[m] * share;
        filter.logGain -= logCosh(scaled);
        const double k = std::tanh(scaled);
        before = a;
        for (std::size_t i = 0; i < m; ++i) {
            a[i] += k * before[m - 1 - i];
        }
        a[m] = k;
    }
    double radius = 1.0;
    for (double& coefficient : a) {
        radius *= poleRadius;
        coefficient *= radius;
    }
    return filter;
}

void ReflectionFilter::run(std::array<double, filterOrder>& past, std::span<const float> drive,
                           std::span<float> filtered) const noexcept {
    constexpr std::size_t older = filterOrder - newest;
    // In the order of time, as the samples lie.
    std::array<double, older> olderTaps{};
    for (std::size_t i = 0; i < older; ++i) {
        olderTaps[i] = coefficients[filterOrder - 1 - i];
    }
    std::array<double, filterOrder + pieceSamples> wave;
    std::ranges::copy(past, wave.begin());
    std::array<double, newest> last{wave[filterOrder - 1], wave[filterOrder - 2], wave[filterOrder - 3],
                                    wave[filterOrder - 4]};
    for (std::size_t n = 0; n < drive.size(); ++n) {
        const double* samples = wave.data() + n;
        std::array<double, 4> sums{};
        for (std::size_t i = 0; i < older; i += sums.size()) {
            for (std::size_t lane = 0; lane < sums.size(); ++lane) {
                sums[lane] += olderTaps[i + lane] * samples[i + lane];
            }
        }
        const double earlier = (sums[0] + sums[2]) + (sums[1] + sums[3]) + coefficients[3] * last[3] +
                               coefficients[2] * last[2] + coefficients[1] * last[1];
        const double y = (static_cast<double>(drive[n]) - earlier) - coefficients[0] * last[0];
        last = {y, last[0], last[1], last[2]};
        wave[filterOrder + n] = y;
        filtered[n] = limitedOrZero(static_cast<float>(y), skeletonLimit);
    }
    std::copy_n(wave.begin() + static_cast<std::ptrdiff_t>(drive.size()), filterOrder, past.begin());
}

std::array<double, filterOrder> ReflectionFilter::stationaryPast(
    std::span<const float, filterOrder> noise) const noexcept {
    const StepDown steps(*this);
    std::array<double, filterOrder> past{};
    for (std::size_t n = 0; n < filterOrder; ++n) {
        double sample = std::sqrt(steps.variances[n]) * static_cast<double>(noise[n]);
        for (std::size_t i = 0; i < n; ++i) {
            sample -= steps.predictors[n][i] * past[n - 1 - i];
        }
        past[n] = sample;
    }
    return past;
}

double ReflectionFilter::variance() const noexcept {
    return StepDown(*this).variances.front();
}

double ReflectionFilter::powerGain(double frequencyHz) const noexcept {
    const std::complex<double> delay = std::polar(1.0, -2.0 * std::numbers::pi * frequencyHz / waveformRateHz);
    std::complex<double> sum = 0.0;
    for (std::size_t i = filterOrder; i > 0; --i) {
        sum = (sum + coefficients[i - 1]) * delay;
    }
    return std::exp(2.0 * logGain) / std::norm(1.0 + sum);
}

}  // namespace haptoflow::skeleton
