// The level of the shipped model with the range law while speed or force increases slowly, far beyond the trained
// range.

#include "engine/range_law.hpp"

#include "engine/material.hpp"
#include "engine/test_model.hpp"
#include "model/model_file.hpp"
#include "support/model_generator.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

namespace haptoflow::engine {
namespace {

Material material(double speed, double force, double frequency) {
    Material result;
    result.speedLevelExponent = speed;
    result.forceLevelExponent = force;
    result.frequencyExponent = frequency;
    return result;
}

TEST(RangeLawTest, InsideTheRangeNothingChanges) {
    const model::ModelFile model = testing::smallModel();
    const RangedMotion ranged = applyRangeLaw(model.header(), material(1.0, 0.5, 1.0), {0.3F, -0.2F}, 2.0F);
    EXPECT_FLOAT_EQ(ranged.motion[0], 0.3F);
    EXPECT_FLOAT_EQ(ranged.motion[1], -0.2F);
    EXPECT_FLOAT_EQ(ranged.motion[2], 2.0F);
    EXPECT_EQ(ranged.levelGain, 1.0);
    EXPECT_EQ(ranged.readingRate, 1.0);
}

TEST(RangeLawTest, BeyondTheRangeTheMotionIsClampedInItsDirection) {
    const model::ModelFile model = testing::smallModel();
    const RangedMotion ranged = applyRangeLaw(model.header(), material(0.0, 0.0, 0.0), {1.2F, 1.6F}, 8.0F);
    EXPECT_NEAR(std::hypot(ranged.motion[0], ranged.motion[1]), 0.4, 1e-6);
    EXPECT_NEAR(ranged.motion[1] / ranged.motion[0], 4.0 / 3.0, 1e-5);
    EXPECT_FLOAT_EQ(ranged.motion[2], 4.0F);
}

TEST(RangeLawTest, LevelAndReadingRateFollowTheLabelsExponents) {
    const model::ModelFile model = testing::smallModel();
    const RangedMotion ranged = applyRangeLaw(model.header(), material(1.0, 0.5, 0.5), {0.8F, 0.0F}, 16.0F);
    EXPECT_NEAR(ranged.levelGain, 2.0 * 2.0, 1e-6);
    EXPECT_NEAR(ranged.readingRate, std::sqrt(2.0), 1e-6);
}

TEST(RangeLawTest, LevelAndReadingRateAreLimited) {
    const model::ModelFile model = testing::smallModel();
    const RangedMotion ranged = applyRangeLaw(model.header(), material(2.0, 1.0, 1.0), {20.0F, 0.0F}, 1000.0F);
    EXPECT_EQ(ranged.levelGain, 16.0);
    EXPECT_EQ(ranged.readingRate, 4.0);
}

TEST(RangeLawTest, ASlowSweepAcrossTheEdgeOfTheRangeHasNoStep) {
    const model::ModelFile model = testing::smallModel();
    const Material mesh = material(0.97, 0.21, 1.0);
    RangedMotion last = applyRangeLaw(model.header(), mesh, {0.0F, 0.0F}, 0.0F);
    for (int i = 1; i <= 20000; ++i) {
        const float share = static_cast<float>(i) / 20000.0F;
        const RangedMotion ranged = applyRangeLaw(model.header(), mesh, {2.0F * share, 0.0F}, 10.0F * share);
        ASSERT_LE(std::abs(ranged.levelGain - last.levelGain), 1e-3);
        ASSERT_LE(std::abs(ranged.readingRate - last.readingRate), 1e-3);
        ASSERT_LE(std::abs(ranged.motion[0] - last.motion[0]), 1e-3F);
        ASSERT_LE(std::abs(ranged.motion[2] - last.motion[2]), 1e-3F);
        last = ranged;
    }
}

constexpr std::array<float, inference::segmentSamples> quiet{};

class RangeSweepTest : public ::testing::Test {
protected:
    /// Level in decibels, including the range law's gain, for each motion of a sweep over a label.
    std::vector<double> levels(std::size_t label, const std::vector<std::array<float, 3>>& motions) {
        MaterialBlend blend;
        blend.add(static_cast<std::uint32_t>(label), 1.0F);
        const Material material = resolveMaterial(MaterialLibrary::ReadScope(library_).ingredients(blend));
        std::vector<inference::SegmentRequest> requests;
        std::vector<double> result;
        for (const auto& motion : motions) {
            const RangedMotion ranged = applyRangeLaw(model_.header(), material, {motion[0], motion[1]}, motion[2]);
            requests.push_back(
                {.embedding = material.embedding, .motion = ranged.motion, .previous = quiet, .noise = quiet});
            result.push_back(20.0 * std::log10(ranged.levelGain));
        }
        std::vector<float> found(requests.size());
        generator_->levels(requests, found);
        for (std::size_t i = 0; i < found.size(); ++i) {
            result[i] += 20.0 * std::log10(static_cast<double>(found[i]));
        }
        return result;
    }

    /// Geometric series from `lowest` to `highest`.
    static std::vector<double> sweep(double lowest, double highest, std::size_t count) {
        std::vector<double> values(count);
        for (std::size_t i = 0; i < count; ++i) {
            values[i] = lowest * std::pow(highest / lowest, static_cast<double>(i) / static_cast<double>(count - 1));
        }
        return values;
    }

    /// The largest change of slope between two steps, in decibels per doubling.
    static double largestKink(const std::vector<double>& decibels, double doublingsOfAStep) {
        double largest = 0.0;
        for (std::size_t i = 1; i + 1 < decibels.size(); ++i) {
            const double change = decibels[i + 1] - 2.0 * decibels[i] + decibels[i - 1];
            largest = std::max(largest, std::abs(change) / doublingsOfAStep);
        }
        return largest;
    }

    static constexpr std::size_t steps = 160;
    // The slope may change gradually. A clamp would change it by 3 to 6 dB per doubling in one step.
    static constexpr double largestAllowedKink = 2.5;

    model::ModelFile model_ = model::ModelFile::read(HAPTOFLOW_TEST_DEFAULT_MODEL);
    std::unique_ptr<inference::TierGenerator> generator_ = haptoflow::testing::generatorOf(model_, 256);
    MaterialLibrary library_{model_, *generator_};
};

TEST_F(RangeSweepTest, FromStandstillToTwoMetresASecondTheLevelHasNeitherAStepNorAKink) {
    const std::vector<double> speeds = sweep(0.004, 2.0, steps);
    std::vector<std::array<float, 3>> motions;
    for (const double speed : speeds) {
        motions.push_back({static_cast<float>(0.8 * speed), static_cast<float>(0.6 * speed), 1.0F});
    }
    for (std::size_t label = 0; label < model_.header().labels.size(); ++label) {
        const std::vector<double> decibels = levels(label, motions);
        for (std::size_t i = 1; i < decibels.size(); ++i) {
            ASSERT_LT(std::abs(decibels[i] - decibels[i - 1]), 1.0) << model_.header().labels[label].name;
        }
        EXPECT_LT(largestKink(decibels, std::log2(speeds[1] / speeds[0])), largestAllowedKink)
            << model_.header().labels[label].name;
    }
}

}  // namespace
}  // namespace haptoflow::engine
