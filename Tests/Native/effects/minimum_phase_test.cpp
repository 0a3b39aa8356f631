#include "effects/parallel_filter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <vector>

namespace haptoflow::effects::minimum_phase_test {
namespace {

TEST(MinimumPhaseTest, ThePhaseOfAResonanceFollowsFromItsMagnitude) {
    constexpr double perOctave = 24.0;
    std::vector<double> magnitude;
    std::vector<double> phase;
    for (int point = 0; point < 400; ++point) {
        const double hz = 1.0 * std::exp2(point / perOctave);
        const std::complex<double> s(0.0, hz / 160.0);
        // A boost of 12 dB at 160 Hz, flat far from it.
        const std::complex<double> response = (s * s + s * 0.8 + 1.0) / (s * s + s * 0.2 + 1.0);
        magnitude.push_back(std::log(std::abs(response)));
        phase.push_back(std::arg(response));
    }
    const std::vector<double> found = minimumPhaseRadians(magnitude, 1.0 / perOctave);
    for (std::size_t point = 0; point < phase.size(); ++point) {
        EXPECT_NEAR(found[point], phase[point], 0.02) << point;
    }
}

TEST(MinimumPhaseTest, AConstantMagnitudeHasNoPhase) {
    for (const double phase : minimumPhaseRadians(std::vector<double>(50, 3.0), 0.1)) {
        EXPECT_EQ(phase, 0.0);
    }
}

}  // namespace
}  // namespace haptoflow::effects::minimum_phase_test
