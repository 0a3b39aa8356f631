#include "learning/linear_algebra.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace haptoflow::learning {
namespace {

SymmetricMatrix example() {
    SymmetricMatrix matrix(3);
    const double values[3][3] = {{4.0, 1.0, -0.5}, {1.0, 3.0, 0.25}, {-0.5, 0.25, 2.0}};
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
            matrix.at(i, j) = values[i][j];
        }
    }
    return matrix;
}

TEST(LinearAlgebraTest, EigenvectorsAreScaledByTheirValuesInDecreasingOrder) {
    const SymmetricMatrix matrix = example();
    const EigenDecomposition axes = decompose(matrix);
    ASSERT_EQ(axes.values.size(), 3U);
    EXPECT_GT(axes.values[0], axes.values[1]);
    EXPECT_GT(axes.values[1], axes.values[2]);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (std::size_t i = 0; i < 3; ++i) {
            double product = 0.0;
            for (std::size_t j = 0; j < 3; ++j) {
                product += matrix.at(i, j) * axes.vectors[axis][j];
            }
            EXPECT_NEAR(product, axes.values[axis] * axes.vectors[axis][i], 1e-10);
        }
    }
}

TEST(LinearAlgebraTest, ASolutionReproducesTheRightSide) {
    const std::vector<double> x = solvePositive(example(), {1.0, 2.0, 3.0});
    EXPECT_NEAR(4.0 * x[0] + x[1] - 0.5 * x[2], 1.0, 1e-12);
    EXPECT_NEAR(-0.5 * x[0] + 0.25 * x[1] + 2.0 * x[2], 3.0, 1e-12);
}

TEST(LinearAlgebraTest, ASingularMatrixGivesFiniteNumbers) {
    SymmetricMatrix matrix(2);
    matrix.at(0, 0) = 1.0;
    for (const double value : solvePositive(matrix, {1.0, 0.0})) {
        EXPECT_TRUE(std::isfinite(value));
    }
}

}  // namespace
}  // namespace haptoflow::learning
