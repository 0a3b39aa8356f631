#include "skeleton/gaussian_noise.hpp"

#include "inference/golden_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <vector>

namespace haptoflow::skeleton {
namespace {

constexpr std::size_t manyNumbers = 1'000'000;

std::vector<float> noise(NoiseKey key, std::size_t count) {
    std::vector<float> values(count);
    fillStandardNormal(key, values);
    return values;
}

const std::vector<float>& manyValues() {
    static const std::vector<float> values = noise({2024, 0, 0}, manyNumbers);
    return values;
}

double correlation(const std::vector<float>& left, const std::vector<float>& right, std::size_t lag) {
    double sum = 0.0;
    const std::size_t count = std::min(left.size(), right.size() - lag);
    for (std::size_t index = 0; index < count; ++index) {
        sum += static_cast<double>(left[index]) * static_cast<double>(right[index + lag]);
    }
    return sum / static_cast<double>(count);
}

double normalDistribution(double value) {
    return 0.5 * std::erfc(-value / std::sqrt(2.0));
}

TEST(PhiloxTest, PhiloxGivesThePublishedOutput) {
    using Words = std::array<std::uint32_t, 4>;
    EXPECT_EQ(philox({0, 0, 0, 0}, {0, 0}), (Words{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
    EXPECT_EQ(philox({0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff}, {0xffffffff, 0xffffffff}),
              (Words{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
    EXPECT_EQ(philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
              (Words{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(GaussianNoiseTest, AgreesWithPythonForEveryGoldenKey) {
    const nlohmann::json golden = haptoflow::testing::readGolden("model/noise.expected.json");
    for (const auto& row : haptoflow::testing::goldenRows(golden, "noise")) {
        const auto expected = row.at("values").get<std::vector<float>>();
        ASSERT_FALSE(expected.empty());
        const NoiseKey key{row.at("seed").get<std::uint64_t>(), row.at("voice").get<std::uint32_t>(),
                           row.at("segment").get<std::uint64_t>()};
        const auto found = noise(key, expected.size());
        for (std::size_t index = 0; index < expected.size(); ++index) {
            EXPECT_NEAR(found[index], expected[index], 1e-6F) << row.dump().substr(0, 60) << " at " << index;
        }
    }
}

TEST(GaussianNoiseTest, TheSameKeyGivesTheSameNoiseForAnyLength) {
    const auto longer = noise({9, 8, 7}, 201);
    const auto shorter = noise({9, 8, 7}, 77);
    EXPECT_TRUE(std::equal(shorter.begin(), shorter.end(), longer.begin()));
}

TEST(GaussianNoiseTest, TheNoiseFollowsTheNormalDistribution) {
    std::vector<float> sorted = manyValues();
    std::sort(sorted.begin(), sorted.end());
    double distance = 0.0;
    for (std::size_t index = 0; index < sorted.size(); ++index) {
        const double expected = normalDistribution(static_cast<double>(sorted[index]));
        const double below = static_cast<double>(index) / static_cast<double>(sorted.size());
        const double above = static_cast<double>(index + 1) / static_cast<double>(sorted.size());
        distance = std::max({distance, std::fabs(expected - below), std::fabs(expected - above)});
    }
    // The Kolmogorov-Smirnov distance that a sample of this size exceeds with a probability of 1/1000.
    EXPECT_LT(distance, 1.95 / std::sqrt(static_cast<double>(manyNumbers)));
}

TEST(GaussianNoiseTest, TheNoiseIsUncorrelatedAtEveryShortLag) {
    for (std::size_t lag = 1; lag <= 20; ++lag) {
        EXPECT_NEAR(correlation(manyValues(), manyValues(), lag), 0.0, 0.0045) << lag;
    }
}

TEST(GaussianNoiseTest, KeysThatDifferInOneBitGiveUncorrelatedNoise) {
    constexpr std::size_t count = 200'000;
    const auto base = noise({5, 5, 5}, count);
    const std::vector<NoiseKey> neighbours = {
        {4, 5, 5}, {5, 4, 5}, {5, 5, 4}, {5 ^ (1ULL << 63U), 5, 5}, {5, 5 ^ (1U << 31U), 5}, {5, 5, 5 ^ (1ULL << 63U)}};
    for (const NoiseKey& key : neighbours) {
        EXPECT_NEAR(correlation(base, noise(key, count), 0), 0.0, 0.01);
    }
}

}  // namespace
}  // namespace haptoflow::skeleton
