#include "skeleton/reflection_filter.hpp"

#include <algorithm>
#include <cmath>
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

void ReflectionFilter::run(std::span<const float, filterOrder> past, Segment drive,
                           std::span<float, segmentSamples> filtered) const noexcept {
    constexpr std::size_t older = filterOrder - newest;
    // In the order of time, as the samples lie.
    std::array<double, older> olderTaps{};
    for (std::size_t i = 0; i < older; ++i) {
        olderTaps[i] = coefficients[filterOrder - 1 - i];
    }
    std::array<double, filterOrder + segmentSamples> wave{};
    std::ranges::copy(past, wave.begin());
    std::array<double, newest> last{wave[filterOrder - 1], wave[filterOrder - 2], wave[filterOrder - 3],
                                    wave[filterOrder - 4]};
    for (std::size_t n = 0; n < segmentSamples; ++n) {
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
        filtered[n] = std::clamp(static_cast<float>(y), -unitLimit, unitLimit);
    }
}

}  // namespace haptoflow::skeleton
