#include "skeleton/surface_noise.hpp"

#include "inference/golden_file.hpp"
#include "skeleton/gaussian_noise.hpp"
#include "support/wave_measures.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

namespace haptoflow::skeleton {
namespace {

using Vector = std::array<double, 3>;

using haptoflow::testing::correlation;

constexpr std::uint64_t object = 7;

Vector along(const Vector& direction, double metres) {
    const double length = std::hypot(direction[0], direction[1], direction[2]);
    return {direction[0] / length * metres, direction[1] / length * metres, direction[2] / length * metres};
}

/// In calls of many sizes.
std::vector<float> noiseOf(SurfacePath path, std::size_t count, std::uint64_t surface = object) {
    SurfaceNoise surfaceNoise;
    std::vector<float> noise(count);
    std::size_t size = 11;
    for (std::size_t first = 0; first < count; first += size) {
        size = std::min(size * 7 % 32 + 1, count - first);
        surfaceNoise.next(surface, path, {}, std::span(noise).subspan(first, size));
        for (std::size_t axis = 0; axis < 3; ++axis) {
            path.startMetres[axis] += path.stepMetres[axis] * static_cast<double>(size);
        }
    }
    return noise;
}

double mean(const std::vector<float>& values, int power, std::size_t lag = 0) {
    double sum = 0.0;
    for (std::size_t index = lag; index < values.size(); ++index) {
        const auto value = static_cast<double>(values[index]);
        sum += lag == 0 ? std::pow(value, power) : value * static_cast<double>(values[index - lag]);
    }
    return sum / static_cast<double>(values.size() - lag);
}

std::vector<float> stroke(double speedMps, const Vector& direction, std::size_t count,
                          const Vector& start = {0.013, -0.021, 0.008}) {
    return noiseOf({.startMetres = start, .stepMetres = along(direction, speedMps / 2000.0)}, count);
}

class SpeedTest : public ::testing::TestWithParam<double> {};

TEST_P(SpeedTest, StrokesInAnyDirectionHaveWhiteStandardNormalNoise) {
    constexpr std::size_t count = 200'000;
    // Five deviations of a mean over 200,000 numbers.
    constexpr double tolerance = 5.0 / 447.0;
    for (const Vector& direction : {Vector{1.0, 0.0, 0.0}, Vector{0.3, 0.7, 0.2}}) {
        const std::vector<float> noise = stroke(GetParam(), direction, count);
        EXPECT_NEAR(mean(noise, 1), 0.0, tolerance);
        EXPECT_NEAR(mean(noise, 2), 1.0, 1.5 * tolerance);
        EXPECT_NEAR(mean(noise, 4) / std::pow(mean(noise, 2), 2), 3.0, 0.1);
        for (std::size_t lag = 1; lag <= 64; ++lag) {
            EXPECT_NEAR(mean(noise, 0, lag), 0.0, tolerance) << "lag " << lag;
        }
        // A sum of neighbours sees what single lags hide: a slow trend, or a level that waves with the cells.
        for (const std::size_t length : {8U, 20U, 200U}) {
            std::vector<float> sums;
            std::vector<float> powers;
            for (std::size_t first = 0; first + length <= count; first += length) {
                double sum = 0.0;
                double power = 0.0;
                for (std::size_t index = first; index < first + length; ++index) {
                    sum += static_cast<double>(noise[index]);
                    power += std::pow(static_cast<double>(noise[index]), 2);
                }
                sums.push_back(static_cast<float>(sum / std::sqrt(static_cast<double>(length))));
                powers.push_back(static_cast<float>(power / static_cast<double>(length) - 1.0));
            }
            const auto blocks = static_cast<double>(sums.size());
            EXPECT_NEAR(mean(sums, 2), 1.0, 5.0 * std::sqrt(2.0 / blocks)) << "sums of " << length;
            EXPECT_NEAR(mean(powers, 2) * static_cast<double>(length), 2.0, 0.2 + 10.0 * std::sqrt(2.0 / blocks))
                << "powers of " << length;
        }
    }
}

TEST_P(SpeedTest, AWayBackFindsTheNoiseOfTheWayThere) {
    const Vector step = along({0.6, -0.2, 0.5}, GetParam() / 2000.0);
    const SurfacePath there{.startMetres = {0.1, 0.2, 0.3}, .stepMetres = step};
    SurfacePath back{.startMetres = there.startMetres, .stepMetres = {-step[0], -step[1], -step[2]}};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        back.startMetres[axis] += step[axis] * 1000.0;
    }
    std::vector<float> found = noiseOf(back, 1000);
    std::ranges::reverse(found);
    EXPECT_GT(correlation(noiseOf(there, 1000), found), 0.999);
}

INSTANTIATE_TEST_SUITE_P(FromCreepingToThrowing, SpeedTest, ::testing::Values(0.001, 0.01, 0.0611, 0.128, 1.0, 20.0));

/// The noise of a stroke whose speed goes from 40 to 160 mm/s and back every two seconds. A new state, with the speed
/// of then, comes every `samplesPerState` samples.
std::vector<float> changingStroke(std::size_t samplesPerState, std::uint64_t surface) {
    SurfaceNoise surfaceNoise;
    std::vector<float> noise;
    std::vector<float> state(samplesPerState);
    while (noise.size() < 240'000) {
        const auto sample = static_cast<double>(noise.size());
        const double turn = std::numbers::pi * sample / 2000.0;
        surfaceNoise.follow();
        surfaceNoise.next(surface,
                          {.startMetres = {5e-5 * sample - 0.06 / std::numbers::pi * std::sin(turn), 0.01, 0.0},
                           .stepMetres = {(0.1 - 0.06 * std::cos(turn)) / 2000.0, 0.0, 0.0}},
                          {}, state);
        noise.insert(noise.end(), state.begin(), state.end());
    }
    return noise;
}

TEST(SurfaceNoiseTest, AStrokeOfChangingSpeedHasTheLevelAndTheTailsOfNormalNoiseHoweverOftenItIsTold) {
    for (const std::size_t samplesPerState : {4U, 17U}) {
        double power = 0.0;
        double beyond = 0.0;
        constexpr std::uint64_t surfaces = 12;
        for (std::uint64_t surface = 0; surface < surfaces; ++surface) {
            const std::vector<float> noise = changingStroke(samplesPerState, surface);
            const auto count = static_cast<double>(noise.size()) * surfaces;
            power += mean(noise, 2) / surfaces;
            beyond +=
                static_cast<double>(std::ranges::count_if(noise, [](float z) { return std::abs(z) > 3.5F; })) / count;
        }
        EXPECT_NEAR(power, 1.0, 0.005) << samplesPerState;
        EXPECT_NEAR(beyond, std::erfc(3.5 / std::numbers::sqrt2), 0.09 * beyond) << samplesPerState;
    }
}

TEST(SurfaceNoiseTest, AnotherPathIsMetWithinEightSamplesAndATurnAtOnce) {
    SurfacePath path{.startMetres = {0.01, 0.02, 0.0}, .stepMetres = {5e-5, 0.0, 0.0}};
    for (const double change : {0.7, 1.2, -1.0}) {
        SurfaceNoise goingOn;
        std::array<float, 20> noise{};
        goingOn.next(object, path, {}, noise);
        SurfacePath other = path;
        other.startMetres[0] += 20.0 * path.stepMetres[0];
        other.stepMetres[0] *= change;
        goingOn.follow();
        std::array<float, 32> found{};
        goingOn.next(object, other, {}, found);
        SurfaceNoise fresh;
        std::array<float, 32> wanted{};
        fresh.next(object, other, {}, wanted);
        // The path is met after 8 samples, or at once after a turn. What was read before leaves the filter 15 samples
        // later.
        const std::size_t met = change < 0.0 ? 15 : 23;
        for (std::size_t n = met; n < found.size(); ++n) {
            EXPECT_NEAR(found[n], wanted[n], 1e-3F) << change << ", " << n;
        }
    }
}

/// The mean of `group` samples each: the noise over longer pieces of the way.
std::vector<float> coarser(const std::vector<float>& noise, std::size_t group) {
    std::vector<float> sums(noise.size() / group);
    for (std::size_t index = 0; index < sums.size() * group; ++index) {
        sums[index / group] += noise[index];
    }
    return sums;
}

TEST(SurfaceNoiseTest, TheSamePlaceHasTheSameNoiseAtOtherSpeeds) {
    const Vector direction{1.0, 0.0, 0.3};
    // Sums over the same 0.5 mm. A sample's ends are rounded to cells of half its way or more.
    const std::vector<float> sums = coarser(stroke(0.1, direction, 12'000), 10);
    EXPECT_GT(correlation(sums, coarser(stroke(0.05, direction, 24'000), 20)), 0.97);
    EXPECT_GT(correlation(sums, coarser(stroke(0.125, direction, 9'600), 8)), 0.97);
    EXPECT_GT(correlation(sums, coarser(stroke(0.01, direction, 120'000), 100)), 0.95);
    EXPECT_GT(correlation(sums, coarser(stroke(1.0, direction, 1'200), 1)), 0.6);
}

/// The noise below 700 Hz, `delay` samples later than asked for: a sinc with a Hann window.
std::vector<float> delayedBelow700Hz(const std::vector<float>& noise, double delay) {
    constexpr int reach = 48;
    constexpr double cutOff = 0.7;
    std::vector<float> delayed;
    for (std::size_t index = reach; index + reach < noise.size(); ++index) {
        double sum = 0.0;
        for (int tap = -reach; tap <= reach; ++tap) {
            const double time = std::numbers::pi * (static_cast<double>(tap) - delay);
            const double sinc = std::abs(time) < 1e-9 ? cutOff : std::sin(cutOff * time) / time;
            sum += sinc * (0.5 + 0.5 * std::cos(time / (reach + 1))) *
                   static_cast<double>(noise[index + static_cast<std::size_t>(tap + reach) - reach]);
        }
        delayed.push_back(static_cast<float>(sum));
    }
    return delayed;
}

TEST(SurfaceNoiseTest, PathsAPartOfASampleApartHaveOneWaveBelow700Hz) {
    for (const double speed : {0.0137, 0.1, 0.128, 0.9}) {
        const Vector direction{0.8, 0.1, -0.6};
        const std::vector<float> early = stroke(speed, direction, 8000);
        for (const double offset : {0.2, 0.5, 0.77}) {
            const Vector later = along(direction, offset * speed / 2000.0);
            const std::vector<float> late =
                stroke(speed, direction, 8000, {0.013 + later[0], -0.021 + later[1], 0.008 + later[2]});
            EXPECT_GT(correlation(delayedBelow700Hz(early, offset), delayedBelow700Hz(late, 0.0)), 0.985)
                << speed << " m/s, " << offset << " samples";
        }
    }
}

TEST(SurfaceNoiseTest, PathsBesideEachOtherLoseTheirLikenessWithinAMillimetre) {
    const auto beside = [](double metres) {
        double sum = 0.0;
        for (int line = 0; line < 8; ++line) {
            const double z = 0.011 * line;
            sum += correlation(stroke(0.1, {1.0, 0.0, 0.0}, 4000, {0.0, 0.0, z}),
                               stroke(0.1, {1.0, 0.0, 0.0}, 4000, {0.0, 0.0, z + metres}));
        }
        return sum / 8.0;
    };
    EXPECT_GT(beside(0.02e-3), 0.5);
    EXPECT_LT(std::abs(beside(1e-3)), 0.1);
    EXPECT_LT(std::abs(beside(10e-3)), 0.05);
}

TEST(SurfaceNoiseTest, AnotherSurfaceHasAnIndependentField) {
    const SurfacePath path{.startMetres = {}, .stepMetres = {0.05e-3, 0.0, 0.0}};
    const std::vector<float> one = noiseOf(path, 10'000, 1);
    for (const std::uint64_t other : {0ULL, 2ULL, 17ULL, 1ULL << 32U, ~0ULL}) {
        EXPECT_NEAR(correlation(one, noiseOf(path, 10'000, other)), 0.0, 0.05) << other;
    }
}

TEST(SurfaceNoiseTest, PathsWithoutWayOrWithNumbersOfNoUseGiveTheOtherNumbers) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    constexpr double infinity = std::numeric_limits<double>::infinity();
    for (const SurfacePath& path :
         {SurfacePath{}, SurfacePath{.startMetres = {nan, 0.0, 0.0}, .stepMetres = {1e-5, 0.0, 0.0}},
          SurfacePath{.startMetres = {}, .stepMetres = {0.0, nan, 0.0}},
          SurfacePath{.startMetres = {infinity, 0.0, 0.0}, .stepMetres = {1e-5, 0.0, 0.0}},
          SurfacePath{.startMetres = {2e6, 0.0, 0.0}, .stepMetres = {1e-5, 0.0, 0.0}},
          SurfacePath{.startMetres = {}, .stepMetres = {1e-9, 0.0, 0.0}},
          SurfacePath{.startMetres = {}, .stepMetres = {1.0, 0.0, 0.0}}}) {
        constexpr NoiseKey otherwise{.seed = 3, .voice = 2, .segment = 1};
        std::array<float, 9> expected{};
        fillStandardNormal(otherwise, expected);
        SurfaceNoise surfaceNoise;
        std::array<float, 9> noise{};
        surfaceNoise.next(object, path, otherwise, std::span(noise).first(4));
        surfaceNoise.skip(2);
        surfaceNoise.next(object, path, otherwise, std::span(noise).subspan(6));
        expected[4] = expected[5] = 0.0F;
        EXPECT_EQ(noise, expected);
    }
}

std::vector<float> noise(NoiseKey key, std::size_t count) {
    std::vector<float> values(count);
    fillStandardNormal(key, values);
    return values;
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

}  // namespace
}  // namespace haptoflow::skeleton
