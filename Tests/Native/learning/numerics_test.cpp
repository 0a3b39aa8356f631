#include "learning/numerics.hpp"
#include "learning/gamma_regression.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

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

/// A rotated ellipsoid, a hundred times longer than wide, with its minimum at (1, -2, 0.5, 0).
double valley(const std::vector<double>& point) {
    const double a = point[0] - 1.0 + point[1] + 2.0;
    const double b = point[0] - 1.0 - (point[1] + 2.0);
    const double c = point[2] - 0.5;
    return 100.0 * a * a + 0.01 * b * b + c * c + point[3] * point[3];
}

std::vector<double> minimised(std::uint64_t seed, int generations) {
    EvolutionStrategy strategy({0.0, 0.0, 0.0, 1.0}, 0.5, 10, seed);
    for (int generation = 0; generation < generations; ++generation) {
        std::vector<double> scores;
        for (const std::vector<double>& point : strategy.ask()) {
            scores.push_back(valley(point));
        }
        strategy.tell(scores);
    }
    return strategy.mean();
}

TEST(EvolutionStrategyTest, TheMinimumOfARotatedEllipsoidIsFound) {
    const std::vector<double> found = minimised(3, 200);
    EXPECT_LT(valley(found), 1e-6);
    EXPECT_NEAR(found[0], 1.0, 1e-2);
    EXPECT_NEAR(found[1], -2.0, 1e-2);
}

TEST(EvolutionStrategyTest, EqualSeedsGiveEqualPointsAndOtherSeedsOtherPoints) {
    EXPECT_EQ(minimised(5, 20), minimised(5, 20));
    EXPECT_NE(minimised(5, 20), minimised(6, 20));
}

std::vector<SpectrumFrame> framesFrom(double slowest, double fastest, double force) {
    std::vector<SpectrumFrame> frames(101);
    for (std::size_t i = 0; i < frames.size(); ++i) {
        frames[i].speedMps = slowest * std::pow(fastest / slowest, static_cast<double>(i) / 100.0);
        frames[i].forceNewtons = force;
    }
    return frames;
}

TEST(ConditionBasisTest, BeyondTheRecordingEveryFunctionIsConstant) {
    const ConditionBasis basis(framesFrom(0.02, 0.2, 1.0));
    EXPECT_EQ(basis.at(0.001, 1.0), basis.at(0.02, 1.0));
    EXPECT_EQ(basis.at(5.0, 1.0), basis.at(0.2, 1.0));
    EXPECT_NE(basis.at(0.05, 1.0), basis.at(0.1, 1.0));
    EXPECT_EQ(basis.at(0.05, 0.0).size(), basis.count());
}

TEST(ConditionBasisTest, AForceThatDoesNotChangeHasNoEffectAndOneEntry) {
    const ConditionBasis basis(framesFrom(0.02, 0.2, 0.7));
    EXPECT_EQ(basis.at(0.05, 0.1), basis.at(0.05, 9.0));
    ASSERT_EQ(basis.forcesNewtons(4).size(), 1U);
    EXPECT_NEAR(basis.forcesNewtons(4)[0], 0.7, 1e-9);
    const std::vector<double> speeds = basis.speedsMps(3);
    ASSERT_EQ(speeds.size(), 3U);
    EXPECT_NEAR(speeds[1], std::sqrt(speeds[0] * speeds[2]), 1e-9);
}

TEST(GammaRegressionTest, TheMeanIsKeptWhereLeastSquaresOfLogarithmsWouldFallShort) {
    std::mt19937 random(3);
    std::exponential_distribution<double> chance(1.0);
    std::vector<double> values;
    std::vector<double> rows;
    for (int i = 0; i < 4000; ++i) {
        const double x = static_cast<double>(i % 41) / 20.0 - 1.0;
        values.push_back(std::exp(1.5 + 0.8 * x) * chance(random));
        rows.insert(rows.end(), {1.0, x});
    }
    const std::vector<double> found = gammaRegression(values, rows, std::vector<double>{10.0, 10.0}, 1.0);
    EXPECT_NEAR(found[0], 1.5, 0.06);
    EXPECT_NEAR(found[1], 0.8, 0.1);
}

TEST(GammaRegressionTest, FarOutliersAndANarrowPriorStayFinite) {
    const std::vector<double> values{1e-9, 1e9, 1.0};
    const std::vector<double> rows{1.0, 1.0, 1.0};
    EXPECT_TRUE(std::isfinite(gammaRegression(values, rows, std::vector<double>{10.0}, 1.0)[0]));
    EXPECT_NEAR(gammaRegression(values, rows, std::vector<double>{1e-6}, 1.0)[0], 0.0, 1e-3);
}

}  // namespace
}  // namespace haptoflow::learning
