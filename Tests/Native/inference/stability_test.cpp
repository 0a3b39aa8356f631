#include "skeleton/skeleton.hpp"
#include "skeleton/skeleton_layout.hpp"
#include "skeleton/skeleton_tensors.hpp"
#include "skeleton/stream.hpp"
#include "skeleton_model.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

// Streams for minutes of waveform: they must neither grow nor fall silent, whatever they are told.

namespace haptoflow::skeleton::testing {
namespace {

// A minute's states of a display of 72 Hz.
constexpr std::size_t minute = 60 * 72;

struct Telling {
    std::array<float, embeddingSize> embedding{};
    Motion motion{};
    StreamParameters parameters{};
};

class StabilityTest : public ::testing::Test {
protected:
    /// Tells a stream `states` times what `tell(state)` says, and reads up to 60 samples after each. Returns its mean
    /// level in dB in each minute: a mean of levels, because a few impulses would decide a mean of powers.
    template <typename Tell>
    std::vector<double> run(const Skeleton& skeleton, std::size_t states, Tell tell) {
        std::vector<double> minutesDb((states + minute - 1) / minute);
        Stream stream;
        for (std::size_t state = 0; state < states; ++state) {
            Telling told = tell(state);
            std::array<double, familyCount> ratesHz{};
            Phases phases{};
            for (std::size_t family = 0; family < familyCount; ++family) {
                ratesHz[family] = told.parameters.families[family].phase.rateHz;
                phases[familyCount + family] = static_cast<float>(ratesHz[family]);
            }
            told.parameters.skeleton =
                skeleton.parametersFor(conditionOf(told.embedding, told.motion, phases), ratesHz);
            if (state == 0) {
                stream.begin(told.parameters, 0.0, {.seed = 4});
            } else {
                stream.follow(told.parameters, static_cast<double>(state % 5));
            }
            std::vector<float> unit(1 + random_() % 60);
            stream.next(&skeleton, unit);
            if (!std::ranges::all_of(unit, [](float sample) { return std::fabs(sample) <= skeletonLimit; })) {
                ADD_FAILURE() << "not bounded at state " << state;
                return minutesDb;
            }
            EXPECT_TRUE(std::isfinite(stream.nextRampedLevelMps2()));
            double squares = 0.0;
            for (const float sample : unit) {
                squares += static_cast<double>(sample) * static_cast<double>(sample);
            }
            minutesDb[state / minute] +=
                10.0 * std::log10(squares / static_cast<double>(unit.size()) + 1e-12) / static_cast<double>(minute);
        }
        return minutesDb;
    }

    double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
    Telling anything(float strength) {
        Telling told;
        std::ranges::generate(told.embedding, [&] { return strength * normal_(random_); });
        std::ranges::generate(told.motion, [&] { return static_cast<float>(between(-0.5, 5.0)); });
        StreamParameters& parameters = told.parameters;
        parameters.levelMps2 = static_cast<float>(std::exp(between(-6.0, 4.0)));
        parameters.surface = random_();
        parameters.isPlaced = random_() % 2 == 0;
        std::ranges::generate(parameters.path.startMetres, [&] { return between(-2.0, 2.0); });
        std::ranges::generate(parameters.path.stepMetres, [&] { return between(-1e-3, 1e-3); });
        for (PlacedFamily& family : parameters.families) {
            family = {.phase = {.cycles = between(-3.0, 3.0), .rateHz = between(-1000.0, 1000.0)},
                      .isPlaced = random_() % 2 == 0};
        }
        return told;
    }

    std::mt19937 random_{17};
    std::normal_distribution<float> normal_;
};

TEST_F(StabilityTest, FourMinutesOfOneMaterialNeitherGrowNorFade) {
    for (const std::uint32_t seed : {1U, 2U, 3U}) {
        const auto skeleton = readSkeleton(read(skeletonModel({.seed = seed, .strength = 0.5F})));
        Telling told = anything(1.0F);
        told.parameters.families = {PlacedFamily{.phase = {.cycles = 0.0, .rateHz = 61.3}, .isPlaced = false}};
        told.parameters.isPlaced = false;
        const auto levelsDb = run(*skeleton, 4 * minute, [&](std::size_t) { return told; });
        const auto [quietest, loudest] = std::ranges::minmax(levelsDb);
        EXPECT_LT(loudest - quietest, 0.6) << "seed " << seed;
    }
}

TEST_F(StabilityTest, APastAtTheLimitRingsOutHoweverOftenStatesCome) {
    constexpr std::size_t second = 2000;
    const TailImpulses tails;
    for (std::uint32_t seed = 1; seed <= 60; ++seed) {
        const auto skeleton = readSkeleton(read(skeletonModel({.seed = seed, .strength = 0.5F})));
        const Telling told = anything(1.0F);
        const SkeletonParameters parameters = skeleton->parametersFor(conditionOf(told.embedding, told.motion, {}), {});
        for (const std::size_t samplesPerState : {4U, 28U}) {
            std::array<float, filterOrder> past{};
            std::ranges::generate(past, [&] { return random_() % 2 == 0 ? skeletonLimit : -skeletonLimit; });
            Synthesis synthesis;
            synthesis.begin(past);
            std::vector<float> unit(samplesPerState);
            const std::vector<float> nothing(samplesPerState);
            for (std::size_t done = 0; done < 2 * second; done += samplesPerState) {
                synthesis.limitPast();
                synthesis.next(tails, parameters, {}, nothing, unit);
            }
            EXPECT_LT(std::fabs(unit.back()), 1e-3F) << "seed " << seed << ", " << samplesPerState;
        }
    }
}

TEST_F(StabilityTest, JumpsOfMaterialSpeedPlacePhaseAndLevelAtEveryStateStayBounded) {
    const auto skeleton = readSkeleton(read(skeletonModel({.seed = 5, .strength = 2.0F})));
    (void)run(*skeleton, minute, [&](std::size_t) { return anything(1.0F); });
}

TEST_F(StabilityTest, BlendsAndEmbeddingsFarOutsideTheLearntOnesStayBounded) {
    const auto skeleton = readSkeleton(read(skeletonModel({.seed = 6, .strength = 2.0F})));
    const Telling one = anything(1.0F);
    const Telling other = anything(1.0F);
    (void)run(*skeleton, minute, [&](std::size_t step) {
        Telling told = one;
        // From one to the other, and ten times as far.
        const float share = static_cast<float>(step % 1000) / 100.0F;
        for (std::size_t i = 0; i < embeddingSize; ++i) {
            told.embedding[i] += share * (other.embedding[i] - one.embedding[i]);
        }
        return told;
    });
    (void)run(*skeleton, minute, [&](std::size_t) { return anything(1e6F); });
}

TEST_F(StabilityTest, NumbersOfNoUseStayBounded) {
    const auto skeleton = readSkeleton(read(skeletonModel({.seed = 7})));
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    constexpr double infinity = std::numeric_limits<double>::infinity();
    (void)run(*skeleton, minute / 4, [&](std::size_t state) {
        Telling told = anything(1.0F);
        const double none = state % 3 == 0 ? nan : state % 3 == 1 ? infinity : -1e300;
        told.parameters.path.startMetres[state % 2] = none;
        told.parameters.path.stepMetres[state % 3] = state % 5 == 0 ? none : 1e-5;
        told.parameters.families[state % familyCount].phase.cycles = none;
        told.parameters.families[state / 7 % familyCount].phase.rateHz = none;
        told.parameters.levelMps2 = state % 4 == 0 ? static_cast<float>(none) : -1.0F;
        told.embedding[state % embeddingSize] = std::numeric_limits<float>::max();
        return told;
    });
}

TEST_F(StabilityTest, TheLevelIsFiniteForEveryMotionAndLearntEmbedding) {
    const auto level = readLevelModel(read(skeletonModel({.seed = 8})));
    for (int trial = 0; trial < 10000; ++trial) {
        const Telling told = anything(10.0F);
        EXPECT_TRUE(std::isfinite(level->logLevel(told.embedding, told.motion)));
    }
}

}  // namespace
}  // namespace haptoflow::skeleton::testing
