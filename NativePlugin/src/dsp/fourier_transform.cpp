#include "dsp/fourier_transform.hpp"

#include <bit>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>

namespace haptoflow::dsp {
namespace {

// A power series, because libc++ (Android, Apple) has no std::cyl_bessel_i.
double besselI0(double x) noexcept {
    const double quarterSquare = 0.25 * x * x;
    double term = 1.0;
    double sum = 1.0;
    for (int k = 1; term > 1e-17 * sum; ++k) {
        term *= quarterSquare / (static_cast<double>(k) * static_cast<double>(k));
        sum += term;
    }
    return sum;
}

}  // namespace

double kaiserBeta(double attenuationDecibels) noexcept {
    return 0.1102 * (attenuationDecibels - 8.7);
}

double kaiserWindow(double position, double beta) noexcept {
    if (std::abs(position) > 1.0) {
        return 0.0;
    }
    return besselI0(beta * std::sqrt(1.0 - position * position)) / besselI0(beta);
}

double normalisedSinc(double x) noexcept {
    if (std::abs(x) < 1e-9) {
        return 1.0;
    }
    const double angle = std::numbers::pi * x;
    return std::sin(angle) / angle;
}

void fourierTransform(std::vector<std::complex<double>>& values, Direction direction) {
    using Complex = std::complex<double>;
    const std::size_t length = values.size();
    if (!std::has_single_bit(length)) {
        throw std::invalid_argument("a Fourier transform of " + std::to_string(length) +
                                    " values; expected a power of two");
    }
    for (std::size_t i = 1, j = 0; i < length; ++i) {
        std::size_t bit = length >> 1;
        for (; (j & bit) != 0; bit >>= 1) {
            j ^= bit;
        }
        j ^= bit;
        if (i < j) {
            std::swap(values[i], values[j]);
        }
    }
    std::vector<Complex> roots(length / 2);
    const double turn = (direction == Direction::inverse ? 2.0 : -2.0) * std::numbers::pi / static_cast<double>(length);
    for (std::size_t i = 0; i < roots.size(); ++i) {
        roots[i] = std::polar(1.0, turn * static_cast<double>(i));
    }
    for (std::size_t half = 1; half < length; half *= 2) {
        const std::size_t rootStride = length / (2 * half);
        for (std::size_t start = 0; start < length; start += 2 * half) {
            for (std::size_t k = 0; k < half; ++k) {
                const Complex odd = values[start + half + k] * roots[k * rootStride];
                values[start + half + k] = values[start + k] - odd;
                values[start + k] += odd;
            }
        }
    }
    if (direction == Direction::inverse) {
        for (Complex& value : values) {
            value /= static_cast<double>(length);
        }
    }
}

void minimumPhaseResponse(std::span<const double> cepstrum, std::span<double> response) noexcept {
    response[0] = std::exp(cepstrum[0]);
    for (std::size_t n = 1; n < response.size(); ++n) {
        double sum = 0.0;
        for (std::size_t k = 1; k <= n; ++k) {
            sum += static_cast<double>(k) * cepstrum[k] * response[n - k];
        }
        response[n] = sum / static_cast<double>(n);
    }
}

}  // namespace haptoflow::dsp
