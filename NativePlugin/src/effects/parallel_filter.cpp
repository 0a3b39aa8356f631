#include "effects/parallel_filter.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace haptoflow::effects {
namespace {

using Complex = std::complex<double>;

constexpr double twoPi = 2.0 * std::numbers::pi;
constexpr double maximumInput = 1e6;
constexpr std::size_t unknowns = 2 * ParallelFilter::sections + 1;
// Keeps the fit from cancelling a section with its neighbour; changes the response by less than 0.01 dB.
constexpr double ridge = 1e-8;

double poleHz(std::size_t section) {
    constexpr auto last = static_cast<double>(ParallelFilter::sections - 1);
    return ParallelFilter::lowestPoleHz *
           std::pow(ParallelFilter::highestPoleHz / ParallelFilter::lowestPoleHz, static_cast<double>(section) / last);
}

/// Bandwidth from half way to the lower pole to half way to the upper one, widened so that neighbours overlap, which
/// reduces the ripple between them.
double poleBandwidthHz(std::size_t section) {
    constexpr double overlap = 1.4;
    static const double half = std::sqrt(poleHz(1) / poleHz(0));
    return overlap * poleHz(section) * (half - 1.0 / half);
}

using Vector = std::array<double, unknowns>;
using Matrix = std::vector<Vector>;

/// Solves a symmetric positive definite system by Cholesky factorisation, in place.
Vector solve(Matrix matrix, Vector right) {
    for (std::size_t row = 0; row < unknowns; ++row) {
        for (std::size_t column = 0; column <= row; ++column) {
            double sum = matrix[row][column];
            for (std::size_t k = 0; k < column; ++k) {
                sum -= matrix[row][k] * matrix[column][k];
            }
            matrix[row][column] =
                row == column ? std::sqrt(std::max(sum, ridge * ridge)) : sum / matrix[column][column];
        }
    }
    for (std::size_t row = 0; row < unknowns; ++row) {
        for (std::size_t k = 0; k < row; ++k) {
            right[row] -= matrix[row][k] * right[k];
        }
        right[row] /= matrix[row][row];
    }
    for (std::size_t row = unknowns; row-- > 0;) {
        for (std::size_t k = row + 1; k < unknowns; ++k) {
            right[row] -= matrix[k][row] * right[k];
        }
        right[row] /= matrix[row][row];
    }
    return right;
}

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
// log frequency, averaged with the weight ln coth(|u| / 2). The slope is constant between two points, so the weight is
// integrated exactly there.
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

ParallelFilter::ParallelFilter(std::span<const ResponsePoint> points, double sampleRateHz)
    : sampleRateHz_(sampleRateHz) {
    for (std::size_t section = 0; section < sections; ++section) {
        const double angle = twoPi * poleHz(section) / sampleRateHz;
        radius_[section] = std::exp(-std::numbers::pi * poleBandwidthHz(section) / sampleRateHz);
        cosine_[section] = std::cos(angle);
        sine_[section] = std::sin(angle);
        back1_[section] = -2.0 * radius_[section] * cosine_[section];
        back2_[section] = radius_[section] * radius_[section];
    }
    // The basis functions: 1, and 1 / A and (1 - 1/z) / A for each section. They stay linearly independent even if the
    // poles are close to 1.
    std::vector<std::array<Complex, unknowns>> rows;
    Vector norm{};
    for (const ResponsePoint& point : points) {
        const Complex delay = std::polar(1.0, -twoPi * point.frequencyHz / sampleRateHz);
        std::array<Complex, unknowns> row{};
        row[0] = 1.0;
        for (std::size_t section = 0; section < sections; ++section) {
            const Complex pole = 1.0 / (1.0 + delay * (back1_[section] + delay * back2_[section]));
            row[2 * section + 1] = pole;
            row[2 * section + 2] = pole * (1.0 - delay);
        }
        for (std::size_t k = 0; k < unknowns; ++k) {
            norm[k] += std::norm(row[k]);
        }
        rows.push_back(row);
    }
    Matrix matrix(unknowns);
    Vector right{};
    for (std::size_t index = 0; index < rows.size(); ++index) {
        for (std::size_t k = 0; k < unknowns; ++k) {
            rows[index][k] /= std::sqrt(norm[k]);
        }
        for (std::size_t k = 0; k < unknowns; ++k) {
            for (std::size_t column = 0; column <= k; ++column) {
                matrix[k][column] += (std::conj(rows[index][k]) * rows[index][column]).real();
            }
            right[k] += (std::conj(rows[index][k]) * points[index].response).real();
        }
    }
    for (std::size_t k = 0; k < unknowns; ++k) {
        matrix[k][k] += ridge;
    }
    const Vector solution = solve(std::move(matrix), right);
    direct_ = solution[0] / std::sqrt(norm[0]);
    for (std::size_t section = 0; section < sections; ++section) {
        const double level = solution[2 * section + 1] / std::sqrt(norm[2 * section + 1]);
        const double difference = solution[2 * section + 2] / std::sqrt(norm[2 * section + 2]);
        in0_[section] = level + difference;
        in1_[section] = -difference;
    }
}

std::complex<double> ParallelFilter::response(double frequencyHz) const noexcept {
    const Complex delay = std::polar(1.0, -twoPi * frequencyHz / sampleRateHz_);
    Complex sum = direct_;
    for (std::size_t section = 0; section < sections; ++section) {
        sum += (in0_[section] + in1_[section] * delay) / (1.0 + delay * (back1_[section] + delay * back2_[section]));
    }
    return sum;
}

void ParallelFilter::scale(double factor) noexcept {
    direct_ *= factor;
    for (std::size_t section = 0; section < sections; ++section) {
        in0_[section] *= factor;
        in1_[section] *= factor;
    }
}

double ParallelFilter::tailSeconds(double peak, double silent) const noexcept {
    double longest = 0.0;
    for (std::size_t section = 0; section < sections; ++section) {
        const double struck = std::max(
            std::abs(in0_[section]),
            ringing(section, in1_[section] - back1_[section] * in0_[section], -back2_[section] * in0_[section]));
        const double loudest = struck * peak / (1.0 - radius_[section]);
        const double share = silent / static_cast<double>(sections);
        if (loudest > share) {
            longest = std::max(longest, std::log(share / loudest) / std::log(radius_[section]) / sampleRateHz_);
        }
    }
    return longest;
}

void ParallelFilter::process(std::span<float> samples) noexcept {
    constexpr std::size_t lanes = 4;
    static_assert(sections % lanes == 0);
    for (float& sample : samples) {
        const double input =
            std::isfinite(sample) ? std::clamp(static_cast<double>(sample), -maximumInput, maximumInput) : 0.0;
        std::array<double, lanes> sums{};
        for (std::size_t group = 0; group < sections; group += lanes) {
            for (std::size_t lane = 0; lane < lanes; ++lane) {
                const std::size_t k = group + lane;
                const double output = in0_[k] * input + state1_[k];
                state1_[k] = in1_[k] * input - back1_[k] * output + state2_[k];
                state2_[k] = -back2_[k] * output;
                sums[lane] += output;
            }
        }
        sample = static_cast<float>(direct_ * input + ((sums[0] + sums[1]) + (sums[2] + sums[3])));
    }
}

void ParallelFilter::reset() noexcept {
    state1_ = {};
    state2_ = {};
}

// Without input, a section's output is y(n) = r^n (y(0) cos n t + b sin n t); its amplitude is sqrt(y(0)^2 + b^2).
double ParallelFilter::ringing(std::size_t section, double first, double second) const noexcept {
    return std::hypot(first, (first * cosine_[section] + second / radius_[section]) / sine_[section]);
}

double ParallelFilter::envelope() const noexcept {
    double sum = 0.0;
    for (std::size_t section = 0; section < sections; ++section) {
        sum += ringing(section, state1_[section], state2_[section]);
    }
    return sum;
}

}  // namespace haptoflow::effects
