#include "skeleton/skeleton.hpp"

#include "skeleton/skeleton_layout.hpp"
#include "skeleton/skeleton_tensors.hpp"
#include "skeleton/synthesis.hpp"
#include "skeleton_model.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace haptoflow::skeleton::testing {
namespace {

using Wave = std::array<float, segmentSamples>;

Wave randomWave(std::uint32_t seed) {
    std::mt19937 random(seed);
    std::normal_distribution<float> normal;
    Wave wave{};
    std::ranges::generate(wave, [&] { return normal(random); });
    return wave;
}

class SkeletonTest : public ::testing::Test {
protected:
    [[nodiscard]] SkeletonParameters parametersFor(const Phases& phases, float impulseGain = 1.0F) const {
        return skeleton_->parametersFor(
            conditionOf(embedding_, motion_, phases),
            {static_cast<double>(phases[3]), static_cast<double>(phases[4]), static_cast<double>(phases[5])},
            impulseGain);
    }
    [[nodiscard]] NetworkInput segmentOf(const Phases& phases, const Wave& noise) const {
        return synthesiseSegment(*skeleton_, parametersFor(phases),
                                 {.phases = phases, .previous = previous_, .noise = noise});
    }

    std::shared_ptr<const Skeleton> skeleton_ = readSkeleton(read(skeletonModel()));
    std::array<float, embeddingSize> embedding_{0.5F, -1.0F, 0.25F};
    Motion motion_{0.1F, -0.05F, 1.0F};
    Wave previous_ = randomWave(1);
    Wave noise_ = randomWave(2);
    const Phases ruled_{0.25F, 0.5F, 0.0F, 60.0F, -130.0F, 0.0F};
};

TEST_F(SkeletonTest, AGainOnTheImpulsesChangesThemAlone) {
    const SkeletonParameters plain = parametersFor(ruled_);
    const SkeletonParameters stronger = parametersFor(ruled_, 2.5F);
    EXPECT_EQ(stronger.filter.coefficients, plain.filter.coefficients);
    EXPECT_EQ(stronger.families[1].lineSine, plain.families[1].lineSine);
    for (std::size_t i = 0; i < plain.impulseGains.size(); ++i) {
        EXPECT_EQ(stronger.impulseGains[i], 2.5F * plain.impulseGains[i]);
    }
}

TEST_F(SkeletonTest, AnUnruledSurfaceHasNoWavesAndItsTurnsDoNotMatter) {
    const Phases still{0.7F, 0.2F, 0.9F, 0.0F, 0.4F, -0.5F};
    const Phases other{0.0F, 0.0F, 0.0F, 0.0F, 0.4F, -0.5F};
    EXPECT_EQ(segmentOf(still, noise_).values, segmentOf(other, noise_).values);
}

TEST_F(SkeletonTest, SamplesAndTurnsThatAreNotNumbersCountAsNothing) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    Wave noise = noise_;
    noise[7] = nan;
    Wave clean = noise_;
    clean[7] = 0.0F;
    EXPECT_EQ(segmentOf(ruled_, noise).values, segmentOf(ruled_, clean).values);
    Phases unknown = ruled_;
    unknown[0] = nan;
    EXPECT_TRUE(std::ranges::all_of(segmentOf(unknown, noise_).values, [](float each) { return std::isfinite(each); }));
    Wave previous = previous_;
    previous.back() = nan;
    Wave unit{};
    toUnitScale(previous, 2.0F, unit);
    EXPECT_EQ(unit.back(), 0.0F);
    EXPECT_EQ(unit.front(), previous_.front() / 2.0F);
}

TEST_F(SkeletonTest, ThePreviousWaveformIsLimitedInUnitScale) {
    Wave loud{};
    loud[0] = 100.0F;
    loud[1] = -std::numeric_limits<float>::infinity();
    toUnitScale(loud, 0.5F, loud);
    EXPECT_EQ(loud[0], 16.0F);
    EXPECT_EQ(loud[1], -16.0F);
}

TEST(LevelModelTest, TheLawIsLinearInTheLogarithmsAndTheCorrectionIsLimited) {
    const auto zeros = [](std::size_t count) { return std::vector<float>(count); };
    std::vector<float> law = zeros(3 * embeddingSize);
    law[0] = 2.0F;
    const std::array<float, 3> bias{0.5F, 0.75F, 0.25F};
    std::vector<float> one{1e6F};
    const Perceptron correction(
        {{zeros(LevelModel::correctionInputs), std::array<float, 1>{10.0F}}, {std::array<float, 1>{1.0F}, zeros(1)}},
        {one, zeros(1)});
    const LevelModel level({law, bias}, correction);
    const std::array<float, embeddingSize> embedding{0.5F};
    const double expected = 1.0 + 0.5 + 0.75 * std::log(0.0605 / 0.06) + 0.25 * std::log(2.02) + 0.9;
    EXPECT_NEAR(level.logLevel(embedding, {0.0F, 0.06F, 2.0F}), expected, 1e-6);
}

}  // namespace
}  // namespace haptoflow::skeleton::testing
