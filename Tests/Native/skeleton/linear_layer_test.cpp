#include "skeleton/perceptron.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace haptoflow::skeleton {
namespace {

std::vector<float> randomNumbers(std::size_t count, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::normal_distribution<float> normal;
    std::vector<float> values(count);
    for (float& value : values) {
        value = normal(random);
    }
    return values;
}

TEST(LinearLayerTest, EveryNumberOfOutputsGivesTheProductOfMatrixAndVector) {
    for (const std::size_t outputs : {1U, 3U, 4U, 5U, 15U, 16U, 17U, 25U, 38U, 130U}) {
        constexpr std::size_t inputs = 7;
        const auto weight = randomNumbers(outputs * inputs, 1);
        const auto bias = randomNumbers(outputs, 2);
        const auto x = randomNumbers(inputs, 3);
        // One number more shows that nothing is written beyond the outputs.
        std::vector<float> y(outputs + 1, 99.0F);
        LinearLayer(weight, bias).apply(x, y);
        for (std::size_t output = 0; output < outputs; ++output) {
            double expected = bias[output];
            for (std::size_t input = 0; input < inputs; ++input) {
                expected += static_cast<double>(weight[output * inputs + input]) * static_cast<double>(x[input]);
            }
            EXPECT_NEAR(y[output], expected, 1e-5) << outputs << " outputs, output " << output;
        }
        EXPECT_EQ(y[outputs], 99.0F);
    }
}

TEST(PerceptronTest, ThreeLayersWithSiluBetweenThemAsWorkedOutByHand) {
    const auto silu = [](double x) { return x / (1.0 + std::exp(-x)); };
    const std::array<float, 2> first{1.0F, -2.0F};
    const std::array<float, 1> firstBias{0.5F};
    const std::array<float, 1> second{3.0F};
    const std::array<float, 1> secondBias{-1.0F};
    const std::array<float, 2> last{2.0F, -1.0F};
    const std::array<float, 2> lastBias{0.25F, 0.0F};
    const Perceptron perceptron({{first, firstBias}, {second, secondBias}}, {last, lastBias});
    const std::array<float, 2> x{0.75F, 0.25F};
    std::array<float, 2> y{};
    perceptron.run(x, y);
    const double hidden = silu(3.0 * silu(0.75) - 1.0);
    EXPECT_NEAR(y[0], 2.0 * hidden + 0.25, 1e-6);
    EXPECT_NEAR(y[1], -hidden, 1e-6);
}

TEST(PerceptronTest, HugeInputsStayFinite) {
    const std::array<float, 1> weight{1e6F};
    const std::array<float, 1> bias{0.0F};
    const Perceptron perceptron({{weight, bias}, {weight, bias}}, {weight, bias});
    for (const float x : {1e6F, -1e6F}) {
        std::array<float, 1> y{};
        perceptron.run(std::array<float, 1>{x}, y);
        EXPECT_TRUE(std::isfinite(y[0])) << x;
    }
}

}  // namespace
}  // namespace haptoflow::skeleton
