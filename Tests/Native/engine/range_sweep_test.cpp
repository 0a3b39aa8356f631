// The level of the shipped model with the range law while speed or force increases slowly, far beyond the trained
// range.
#include "engine/material.hpp"
#include "engine/range_law.hpp"
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

constexpr std::array<float, inference::segmentSamples> silence{};

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
                {.embedding = material.embedding, .motion = ranged.motion, .previous = silence, .noise = silence});
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
