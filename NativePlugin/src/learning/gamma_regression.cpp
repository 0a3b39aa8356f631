#include "learning/gamma_regression.hpp"

#include "learning/linear_algebra.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace haptoflow::learning {
namespace {

constexpr int rounds = 20;
constexpr double settled = 1e-4;

double product(std::span<const double> left, std::span<const double> right) {
    return std::inner_product(left.begin(), left.end(), right.begin(), 0.0);
}

}  // namespace

std::vector<double> gammaRegression(std::span<const double> values, std::span<const double> rows,
                                    std::span<const double> deviations, double weight) {
    const std::size_t count = deviations.size();
    SymmetricMatrix information(count);
    const auto rowOf = [&](std::size_t index) { return rows.subspan(index * count, count); };
    for (std::size_t index = 0; index < values.size(); ++index) {
        const auto row = rowOf(index);
        for (std::size_t i = 0; i < count; ++i) {
            for (std::size_t j = 0; j < count; ++j) {
                information.at(i, j) += weight * row[i] * row[j];
            }
        }
    }
    for (std::size_t i = 0; i < count; ++i) {
        information.at(i, i) += 1.0 / (deviations[i] * deviations[i]);
    }
    const PositiveFactor factor(information);
    std::vector<double> found(count);
    for (int round = 0; round < rounds; ++round) {
        std::vector<double> score(count);
        for (std::size_t i = 0; i < count; ++i) {
            score[i] = -found[i] / (deviations[i] * deviations[i]);
        }
        for (std::size_t index = 0; index < values.size(); ++index) {
            const auto row = rowOf(index);
            const double excess = values[index] * std::exp(-product(row, found)) - 1.0;
            for (std::size_t i = 0; i < count; ++i) {
                score[i] += weight * row[i] * excess;
            }
        }
        const std::vector<double> change = factor.solve(std::move(score));
        double largest = 0.0;
        for (std::size_t index = 0; index < values.size(); ++index) {
            largest = std::max(largest, std::abs(product(rowOf(index), change)));
        }
        const double share = largest > largestLogStep ? largestLogStep / largest : 1.0;
        for (std::size_t i = 0; i < count; ++i) {
            found[i] += share * change[i];
        }
        if (largest < settled) {
            break;
        }
    }
    return found;
}

}  // namespace haptoflow::learning
