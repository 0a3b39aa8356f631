#include "learning/linear_algebra.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace haptoflow::learning {
namespace {

constexpr int maximumSweeps = 60;

double offDiagonal(const SymmetricMatrix& matrix) {
    double sum = 0.0;
    for (std::size_t i = 0; i < matrix.size; ++i) {
        for (std::size_t j = i + 1; j < matrix.size; ++j) {
            sum += matrix.at(i, j) * matrix.at(i, j);
        }
    }
    return sum;
}

void rotate(SymmetricMatrix& matrix, SymmetricMatrix& vectors, std::size_t p, std::size_t q) {
    const double element = matrix.at(p, q);
    if (element == 0.0) {
        return;
    }
    const double theta = (matrix.at(q, q) - matrix.at(p, p)) / (2.0 * element);
    const double tangent = (theta >= 0.0 ? 1.0 : -1.0) / (std::abs(theta) + std::sqrt(theta * theta + 1.0));
    const double cosine = 1.0 / std::sqrt(tangent * tangent + 1.0);
    const double sine = tangent * cosine;
    for (std::size_t i = 0; i < matrix.size; ++i) {
        const double one = matrix.at(i, p);
        const double other = matrix.at(i, q);
        matrix.at(i, p) = cosine * one - sine * other;
        matrix.at(i, q) = sine * one + cosine * other;
    }
    for (std::size_t i = 0; i < matrix.size; ++i) {
        const double one = matrix.at(p, i);
        const double other = matrix.at(q, i);
        matrix.at(p, i) = cosine * one - sine * other;
        matrix.at(q, i) = sine * one + cosine * other;
        const double first = vectors.at(p, i);
        const double second = vectors.at(q, i);
        vectors.at(p, i) = cosine * first - sine * second;
        vectors.at(q, i) = sine * first + cosine * second;
    }
}

bool factorise(SymmetricMatrix& matrix) {
    for (std::size_t j = 0; j < matrix.size; ++j) {
        for (std::size_t i = j; i < matrix.size; ++i) {
            double sum = matrix.at(i, j);
            for (std::size_t k = 0; k < j; ++k) {
                sum -= matrix.at(i, k) * matrix.at(j, k);
            }
            if (i == j) {
                if (!(sum > 0.0)) {
                    return false;
                }
                matrix.at(j, j) = std::sqrt(sum);
            } else {
                matrix.at(i, j) = sum / matrix.at(j, j);
            }
        }
    }
    return true;
}

}  // namespace

EigenDecomposition decompose(SymmetricMatrix matrix) {
    const std::size_t size = matrix.size;
    SymmetricMatrix vectors(size);
    double scale = 0.0;
    for (std::size_t i = 0; i < size; ++i) {
        vectors.at(i, i) = 1.0;
        scale += matrix.at(i, i) * matrix.at(i, i);
    }
    for (int sweep = 0; sweep < maximumSweeps && offDiagonal(matrix) > 1e-24 * scale; ++sweep) {
        for (std::size_t p = 0; p < size; ++p) {
            for (std::size_t q = p + 1; q < size; ++q) {
                rotate(matrix, vectors, p, q);
            }
        }
    }
    std::vector<std::size_t> order(size);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::sort(order, {}, [&](std::size_t each) { return std::pair(-matrix.at(each, each), each); });
    EigenDecomposition result;
    for (const std::size_t row : order) {
        result.values.push_back(matrix.at(row, row));
        std::vector<double> vector(vectors.values.begin() + static_cast<std::ptrdiff_t>(row * size),
                                   vectors.values.begin() + static_cast<std::ptrdiff_t>((row + 1) * size));
        const auto largest =
            std::ranges::max_element(vector, [](double a, double b) { return std::abs(a) < std::abs(b); });
        if (largest != vector.end() && *largest < 0.0) {
            std::ranges::transform(vector, vector.begin(), [](double value) { return -value; });
        }
        result.vectors.push_back(std::move(vector));
    }
    return result;
}

PositiveFactor::PositiveFactor(const SymmetricMatrix& matrix) : factor_(matrix) {
    constexpr int maximumTries = 12;
    double ridge = 1e-12;
    for (int attempt = 0; attempt < maximumTries && !factorise(factor_); ++attempt) {
        factor_ = matrix;
        for (std::size_t i = 0; i < matrix.size; ++i) {
            factor_.at(i, i) += ridge * (1.0 + std::abs(matrix.at(i, i)));
        }
        ridge *= 10.0;
    }
}

std::vector<double> PositiveFactor::solve(std::vector<double> right) const {
    for (std::size_t i = 0; i < factor_.size; ++i) {
        for (std::size_t k = 0; k < i; ++k) {
            right[i] -= factor_.at(i, k) * right[k];
        }
        right[i] /= factor_.at(i, i);
    }
    for (std::size_t i = factor_.size; i-- > 0;) {
        for (std::size_t k = i + 1; k < factor_.size; ++k) {
            right[i] -= factor_.at(k, i) * right[k];
        }
        right[i] /= factor_.at(i, i);
    }
    return right;
}

std::vector<double> solvePositive(const SymmetricMatrix& matrix, std::vector<double> right) {
    return PositiveFactor(matrix).solve(std::move(right));
}

}  // namespace haptoflow::learning
