#include "engine/onset_levels.hpp"

#include "test_model.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace haptoflow::engine {
namespace {

/// Levels as a level graph gives them: powers of speed and force, a figure of eight over direction.
double level(double vx, double vy, double newtons, double first) {
    const double speed = std::hypot(vx, vy);
    const double along = std::cos(2.0 * std::atan2(vy, vx));
    return (0.5 + first) * std::pow(speed, 0.7) * std::pow(newtons, 0.4) * std::exp(0.2 * along);
}

class PowerLaw final : public inference::SegmentGenerator {
public:
    void generate(std::span<const inference::SegmentRequest>, std::span<float>) override {}
    void levels(std::span<const inference::SegmentRequest> requests, std::span<float> levelsMps2) override {
        for (std::size_t i = 0; i < requests.size(); ++i) {
            const auto& motion = requests[i].motion;
            levelsMps2[i] = static_cast<float>(
                level(motion[0], motion[1], motion[2], static_cast<double>(std::abs(requests[i].embedding[3]))));
        }
    }
};

double decibels(double ratio) {
    return std::abs(20.0 * std::log10(ratio));
}

MaterialBlend blendOf(std::initializer_list<LabelWeight> entries) {
    MaterialBlend blend;
    for (const LabelWeight& entry : entries) {
        blend.entries[blend.count++] = entry;
    }
    return blend;
}

class OnsetLevelsTest : public ::testing::Test {
protected:
    [[nodiscard]] double expected(std::size_t label, double vx, double vy, double newtons) const {
        return level(vx, vy, newtons, static_cast<double>(std::abs(model_.embedding(label)[3])));
    }

    model::ModelFile model_ = testing::smallModel();
    PowerLaw graph_;
    OnsetLevels levels_{model_, graph_};
};

TEST_F(OnsetLevelsTest, EverywhereInTheRangeTheTableIsWithinHalfADecibelOfTheGraph) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> share(0.0, 1.0);
    for (int trial = 0; trial < 2000; ++trial) {
        const double speed = 0.01 * std::pow(40.0, share(random));
        const double angle = 2.0 * std::numbers::pi * share(random);
        const double newtons = 0.1 * std::pow(40.0, share(random));
        const double vx = speed * std::cos(angle);
        const double vy = speed * std::sin(angle);
        const float found = levels_.at(blendOf({{.label = 1, .weight = 1.0F}}),
                                       {static_cast<float>(vx), static_cast<float>(vy), static_cast<float>(newtons)});
        ASSERT_LT(decibels(static_cast<double>(found) / expected(1, vx, vy, newtons)), 0.5);
    }
}

TEST_F(OnsetLevelsTest, ABlendLiesBetweenItsLabelsInDecibels) {
    const std::array<float, 3> motion{0.1F, 0.0F, 1.0F};
    const float first = levels_.at(blendOf({{.label = 0, .weight = 1.0F}}), motion);
    const float second = levels_.at(blendOf({{.label = 1, .weight = 1.0F}}), motion);
    const float mixed = levels_.at(blendOf({{.label = 0, .weight = 0.25F}, {.label = 1, .weight = 0.25F}}), motion);
    EXPECT_NEAR(mixed, std::sqrt(first * second), 1e-4F);
}

TEST_F(OnsetLevelsTest, BeyondTheRangeAndAtRestItStaysAtTheEdge) {
    const MaterialBlend oak = blendOf({{.label = 0, .weight = 1.0F}});
    EXPECT_EQ(levels_.at(oak, {0.4F, 0.0F, 4.0F}), levels_.at(oak, {4.0F, 0.0F, 400.0F}));
    EXPECT_EQ(levels_.at(oak, {0.01F, 0.0F, 0.1F}), levels_.at(oak, {0.0F, 0.0F, 0.0F}));
}

TEST_F(OnsetLevelsTest, UnknownLabelsAreLeftOutAndABlendOfNoneIsTheFirst) {
    const std::array<float, 3> motion{0.1F, 0.0F, 1.0F};
    const float first = levels_.at(blendOf({{.label = 0, .weight = 1.0F}}), motion);
    EXPECT_EQ(levels_.at(MaterialBlend{}, motion), first);
    EXPECT_EQ(levels_.at(blendOf({{.label = 900, .weight = 1.0F}, {.label = 0, .weight = 0.1F}}), motion), first);
    EXPECT_EQ(levels_.at(blendOf({{.label = 1, .weight = 0.0F}}), motion), first);
}

}  // namespace
}  // namespace haptoflow::engine
