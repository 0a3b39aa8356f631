#pragma once

#include <cstddef>
#include <vector>

namespace haptoflow::learning {

/// A small dense symmetric matrix, row by row.
struct SymmetricMatrix {
    explicit SymmetricMatrix(std::size_t order) : size(order), values(order * order) {}

    [[nodiscard]] double& at(std::size_t row, std::size_t column) { return values[row * size + column]; }
    [[nodiscard]] double at(std::size_t row, std::size_t column) const { return values[row * size + column]; }

    std::size_t size;
    std::vector<double> values;
};

/// Eigenvalues, the largest first, and for each its eigenvector of length 1, row by row. The sign of a vector makes its
/// largest component positive, so that equal matrices give equal bytes.
struct EigenDecomposition {
    std::vector<double> values;
    std::vector<std::vector<double>> vectors;
};

/// By Jacobi's rotations.
[[nodiscard]] EigenDecomposition decompose(SymmetricMatrix matrix);

/// x of matrix x = right, for a positive definite matrix, by Cholesky; a small ridge is added where it is not.
[[nodiscard]] std::vector<double> solvePositive(SymmetricMatrix matrix, std::vector<double> right);

}  // namespace haptoflow::learning
