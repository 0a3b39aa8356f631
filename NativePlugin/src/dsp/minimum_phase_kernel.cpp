#include "dsp/minimum_phase_kernel.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "dsp/fourier_transform.hpp"
#include "dsp/kaiser_window.hpp"

namespace haptoflow::dsp {
namespace {

using Complex = std::complex<double>;

// With this grid the error of cubic interpolation is below -110 dB.
constexpr std::size_t gridPerInputSample = 32;
constexpr std::size_t halfLength = 27;
constexpr double attenuationDecibels = 84.0;
// 18 times the kernel's length, so that cepstral aliasing stays below the stopband.
constexpr std::size_t transformLength = std::size_t{1} << 15;
// Keeps the logarithm finite at the zeros of the stopband.
constexpr double magnitudeFloor = 1e-6;

std::vector<Complex> linearPhasePrototype() {
    const double beta = kaiserBeta(attenuationDecibels);
    const auto half = static_cast<double>(halfLength);
    std::vector<Complex> prototype(transformLength);
    for (std::size_t i = 0; i <= 2 * halfLength * gridPerInputSample; ++i) {
        const double t = static_cast<double>(i) / static_cast<double>(gridPerInputSample) - half;
        prototype[i] = normalisedSinc(t) * kaiserWindow(t / half, beta);
    }
    return prototype;
}

}  // namespace

const MinimumPhaseKernel& MinimumPhaseKernel::shared() {
    static const MinimumPhaseKernel kernel;
    return kernel;
}

// Folding the cepstrum of log |H| onto positive time gives the minimum-phase filter of the same magnitude:
// A. V. Oppenheim and R. W. Schafer, "Discrete-Time Signal Processing", chapter on homomorphic filtering.
MinimumPhaseKernel::MinimumPhaseKernel() {
    std::vector<Complex> values = linearPhasePrototype();
    fourierTransform(values, Direction::forward);
    const double floor = magnitudeFloor * std::abs(values[0]);
    for (Complex& value : values) {
        value = std::log(std::max(std::abs(value), floor));
    }
    fourierTransform(values, Direction::inverse);
    for (std::size_t i = 1; i < transformLength / 2; ++i) {
        values[i] *= 2.0;
        values[transformLength - i] = 0.0;
    }
    fourierTransform(values, Direction::forward);
    for (Complex& value : values) {
        value = std::exp(value);
    }
    fourierTransform(values, Direction::inverse);

    grid_.resize(lengthInputSamples * gridPerInputSample);
    double sum = 0.0;
    for (std::size_t i = 0; i < grid_.size(); ++i) {
        grid_[i] = values[i].real();
        sum += grid_[i];
    }
    for (double& value : grid_) {
        value *= static_cast<double>(gridPerInputSample) / sum;
    }
}

double MinimumPhaseKernel::at(double inputSamples) const noexcept {
    if (!(inputSamples >= 0.0) || inputSamples >= static_cast<double>(lengthInputSamples)) {
        return 0.0;
    }
    const double position = inputSamples * static_cast<double>(gridPerInputSample);
    const auto index = static_cast<std::ptrdiff_t>(position);
    const double x = position - static_cast<double>(index);
    const auto point = [&](std::ptrdiff_t offset) {
        const std::ptrdiff_t i = index + offset;
        return i >= 0 && i < std::ssize(grid_) ? grid_[static_cast<std::size_t>(i)] : 0.0;
    };
    return point(-1) * (-x * (x - 1.0) * (x - 2.0) / 6.0) + point(0) * ((x + 1.0) * (x - 1.0) * (x - 2.0) / 2.0) +
           point(1) * (-(x + 1.0) * x * (x - 2.0) / 2.0) + point(2) * ((x + 1.0) * x * (x - 1.0) / 6.0);
}

double MinimumPhaseKernel::groupDelay(double cyclesPerInputSample) const noexcept {
    Complex response = 0.0;
    Complex delayed = 0.0;
    for (std::size_t i = 0; i < grid_.size(); ++i) {
        const double t = static_cast<double>(i) / static_cast<double>(gridPerInputSample);
        const Complex value = std::polar(1.0, -2.0 * std::numbers::pi * cyclesPerInputSample * t) * grid_[i];
        response += value;
        delayed += value * t;
    }
    return (delayed / response).real();
}

}  // namespace haptoflow::dsp
