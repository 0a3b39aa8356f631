#pragma once

#include <span>
#include <vector>

namespace haptoflow::learning {

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
