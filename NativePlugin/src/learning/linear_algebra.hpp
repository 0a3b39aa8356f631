#pragma once

#include <cstddef>
#include <vector>

namespace haptoflow::learning {

/// A small dense symmetric matrix, row by row. Home-made: these two algorithms are all that learning needs, and their
/// fixed order of operations gives equal bytes on all platforms.
struct SymmetricMatrix {
    explicit SymmetricMatrix(std::size_t order) : size(order), values(order * order) {}

    [[nodiscard]] double& at(std::size_t row, std::size_t column) { return values[row * size + column]; }
    [[nodiscard]] double at(std::size_t row, std::size_t column) const { return values[row * size + column]; }

    std::size_t size;
    std::vector<double> values;
};

/// Eigenvalues in decreasing order and the unit eigenvector of each, row by row. The largest component of each vector
/// is positive, so that equal matrices give equal bytes.
struct EigenDecomposition {
    std::vector<double> values;
    std::vector<std::vector<double>> vectors;
};

/// By Jacobi rotations.
[[nodiscard]] EigenDecomposition decompose(SymmetricMatrix matrix);

/// The Cholesky decomposition of a positive definite matrix; of one that is not, with a small ridge.
class PositiveFactor {
public:
    explicit PositiveFactor(const SymmetricMatrix& matrix);

    /// Solves matrix x = right.
    [[nodiscard]] std::vector<double> solve(std::vector<double> right) const;

private:
    SymmetricMatrix factor_;
};

/// Solves matrix x = right once.
[[nodiscard]] std::vector<double> solvePositive(const SymmetricMatrix& matrix, std::vector<double> right);

}  // namespace haptoflow::learning
