#include "learning/gamma_regression.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace haptoflow::learning {
namespace {

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
