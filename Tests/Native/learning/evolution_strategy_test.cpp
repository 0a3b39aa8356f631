#include "learning/evolution_strategy.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace haptoflow::learning {
namespace {

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

TEST(EvolutionStrategyTest, AStartWithoutCoordinatesIsRefused) {
    EXPECT_THROW(EvolutionStrategy({}, 0.5, 10, 1), std::invalid_argument);
}

}  // namespace
}  // namespace haptoflow::learning
