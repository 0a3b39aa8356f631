#include "dsp/kaiser_window.hpp"

#include <cmath>
#include <numbers>

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

}  // namespace haptoflow::dsp
