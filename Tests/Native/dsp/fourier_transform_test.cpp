#include "dsp/fourier_transform.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <random>
#include <stdexcept>
#include <vector>

namespace haptoflow::dsp {
namespace {

TEST(FourierTransformTest, TheResultEqualsTheDefiningSumAndTheInverseRestoresTheInput) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    std::vector<std::complex<double>> values(64);
    for (std::complex<double>& value : values) {
        value = {uniform(random), uniform(random)};
    }
    std::vector<std::complex<double>> transformed = values;
    fourierTransform(transformed, Direction::forward);
    for (std::size_t bin = 0; bin < values.size(); ++bin) {
        std::complex<double> sum = 0.0;
        for (std::size_t i = 0; i < values.size(); ++i) {
            sum += values[i] * std::polar(1.0, -2.0 * std::numbers::pi * static_cast<double>(bin * i) / 64.0);
        }
        EXPECT_NEAR(std::abs(transformed[bin] - sum), 0.0, 1e-12) << bin;
    }
    fourierTransform(transformed, Direction::inverse);
    for (std::size_t i = 0; i < values.size(); ++i) {
        EXPECT_NEAR(std::abs(transformed[i] - values[i]), 0.0, 1e-13) << i;
    }
}

TEST(FourierTransformTest, LengthsThatAreNotAPowerOfTwoAreRejected) {
    for (const std::size_t length : {0U, 3U, 100U}) {
        std::vector<std::complex<double>> values(length);
        EXPECT_THROW(fourierTransform(values, Direction::forward), std::invalid_argument) << length;
    }
}

}  // namespace
}  // namespace haptoflow::dsp
