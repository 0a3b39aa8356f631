#pragma once

#include "learning/texture_figures.hpp"

#include <array>
#include <span>
#include <vector>

namespace haptoflow::learning {

/// Smooth functions of speed and force over what a recording holds. Inside, the logarithms are scaled to a standard
/// deviation of 1; beyond the third and the 97th percentile of the frames, every function is constant.
class ConditionBasis {
public:
    /// `frames` is not empty.
    explicit ConditionBasis(std::span<const SpectrumFrame> frames);

    /// Number of functions: 1, speed, force and Gaussians.
    [[nodiscard]] std::size_t count() const noexcept { return 3 + speedCentres_.size() * forceCentres_.size(); }
    /// Functions from this one on are Gaussians.
    static constexpr std::size_t firstGaussian = 3;
    [[nodiscard]] std::vector<double> at(double speedMps, double newtons) const;

    static constexpr std::size_t cubicCount = 10;
    /// 1, speed, force and their products of second and third degree.
    [[nodiscard]] std::array<double, cubicCount> cubicAt(double speedMps, double newtons) const;

    /// Speeds and forces, evenly distributed over the logarithm, from one end of the range to the other. One force
    /// if it hardly changes.
    [[nodiscard]] std::vector<double> speedsMps(std::size_t count) const { return speed_.evenly(count); }
    [[nodiscard]] std::vector<double> forcesNewtons(std::size_t count) const { return force_.evenly(count); }

private:
    struct Scale {
        explicit Scale(std::vector<double> values);

        double mean = 0.0;
        double deviation = 1.0;
        double lowest = 0.0;
        double highest = 0.0;

        /// False if the values hardly differ: the scaled value is then 0.
        [[nodiscard]] bool varies() const noexcept;
        [[nodiscard]] double scaled(double value) const;
        /// Scaled values at even distances.
        [[nodiscard]] std::vector<double> centres(std::size_t count) const;
        [[nodiscard]] std::vector<double> evenly(std::size_t count) const;
    };

    Scale speed_;
    Scale force_;
    std::vector<double> speedCentres_;
    std::vector<double> forceCentres_;
};

/// Fits log E[value] = row . coefficients to positive values with a Gamma distribution (McCullagh and Nelder,
/// "Generalized linear models", 8.3), by Fisher scoring with a normal prior of mean 0 for each coefficient.
///
/// Shapes: `values` [n], `rows` [n][p] one row after the other, `deviations` [p] of the prior. `weight`: of one value,
/// one over the square of its coefficient of variation. Unlike least squares of the logarithms, it keeps the mean of
/// the values.
[[nodiscard]] std::vector<double> gammaRegression(std::span<const double> values, std::span<const double> rows,
                                                  std::span<const double> deviations, double weight);

/// Largest change of a logarithm in one round; a larger step is shortened, because the first ones overshoot.
inline constexpr double largestLogStep = 1.0;

}  // namespace haptoflow::learning
