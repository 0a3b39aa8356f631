#include "effects/minimum_phase.hpp"

#include <cmath>
#include <cstddef>
#include <numbers>

namespace haptoflow::effects {
namespace {

/// The integral of ln coth(u / 2) from 0 to x, an odd function.
double weightUpTo(double x) {
    const double distance = std::abs(x);
    double integral = 0.0;
    if (distance > 0.5) {
        integral = std::numbers::pi * std::numbers::pi / 4.0;
        for (int order = 1; order < 80; order += 2) {
            integral -= 2.0 * std::exp(-order * distance) / (order * order);
        }
    } else if (distance > 0.0) {
        integral = distance * (std::log(2.0 / distance) + 1.0) + std::pow(distance, 3.0) / 36.0 -
                   7.0 * std::pow(distance, 5.0) / 7200.0;
    }
    return std::copysign(integral, x);
}

}  // namespace

// H. W. Bode, "Network Analysis and Feedback Amplifier Design", 1945: the phase is the slope of the log magnitude over
// log frequency, averaged with the weight ln coth(|u| / 2). Between two points the slope is constant, so that the
// weight can be integrated exactly.
std::vector<double> minimumPhaseRadians(std::span<const double> logMagnitude, double octavesPerPoint) {
    const double step = octavesPerPoint * std::numbers::ln2;
    const std::size_t count = logMagnitude.size();
    std::vector<double> weights(2 * count);
    for (std::size_t cell = 0; cell < weights.size(); ++cell) {
        const double from = (static_cast<double>(cell) - static_cast<double>(count)) * step;
        weights[cell] = weightUpTo(from + step) - weightUpTo(from);
    }
    std::vector<double> phase(count);
    for (std::size_t point = 0; point < count; ++point) {
        double sum = 0.0;
        for (std::size_t cell = 0; cell + 1 < count; ++cell) {
            sum += (logMagnitude[cell + 1] - logMagnitude[cell]) / step * weights[cell + count - point];
        }
        phase[point] = sum / std::numbers::pi;
    }
    return phase;
}

}  // namespace haptoflow::effects
