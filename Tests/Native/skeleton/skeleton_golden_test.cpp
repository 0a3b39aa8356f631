#include "../inference/golden_file.hpp"
#include "skeleton/skeleton.hpp"
#include "skeleton/skeleton_layout.hpp"
#include "skeleton/skeleton_tensors.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

// Compares every step with what the training's program wrote for the same random weights.

namespace haptoflow::skeleton::testing {
namespace {

constexpr double tolerance = 1e-5;

using Wave = std::array<float, segmentSamples>;

double rmsOf(const std::vector<double>& values) {
    double squares = 0.0;
    for (const double value : values) {
        squares += value * value;
    }
    return std::sqrt(squares / static_cast<double>(values.size()));
}

/// Expects that no number is further from `expected` than the tolerance times `scale`.
template <typename Numbers>
void expectNear(const Numbers& found, const std::vector<double>& expected, double scale, const char* what) {
    ASSERT_EQ(found.size(), expected.size()) << what;
    double largest = 0.0;
    for (std::size_t i = 0; i < expected.size(); ++i) {
        largest = std::max(largest, std::fabs(static_cast<double>(found[i]) - expected[i]));
    }
    EXPECT_LE(largest / scale, tolerance) << what;
}

class SkeletonGoldenTest : public ::testing::Test {
protected:
    template <typename Compare>
    void forEveryCase(Compare compare) {
        const nlohmann::json golden = haptoflow::testing::readGolden("model/skeleton.parity.json");
        std::size_t place = 0;
        for (const auto& row : haptoflow::testing::goldenRows(golden, "cases")) {
            SCOPED_TRACE("case " + std::to_string(place));
            ++place;
            const auto embedding = row.at("embedding").get<std::array<float, embeddingSize>>();
            const auto motion = row.at("motion").get<Motion>();
            const auto previous = row.at("previous").get<Wave>();
            const auto noise = row.at("noise").get<Wave>();
            Wave unit{};
            toUnitScale(previous, static_cast<float>(std::exp(number(row, "log_level"))), unit);
            compare(row, Moment{.embedding = embedding,
                                .motion = motion,
                                .phases = row.at("phases").get<Phases>(),
                                .previous = unit,
                                .noise = noise});
        }
    }

    static std::vector<double> numbers(const nlohmann::json& row, const char* key) {
        return row.at(key).get<std::vector<double>>();
    }

    /// A number that stands alone in an array.
    static double number(const nlohmann::json& row, const char* key) { return numbers(row, key).at(0); }

    model::ModelFile model_ = model::ModelFile::read(HAPTOFLOW_TEST_GOLDEN_DIR "/model/skeleton.haptoflow");
    std::shared_ptr<const Skeleton> skeleton_ = readSkeleton(model_);
};

TEST_F(SkeletonGoldenTest, LevelsAgree) {
    const auto level = readLevelModel(model_);
    forEveryCase([&](const nlohmann::json& row, const Moment& moment) {
        EXPECT_NEAR(level->logLevel(moment.embedding, moment.motion), number(row, "log_level"), tolerance);
    });
}

TEST_F(SkeletonGoldenTest, FiltersAgree) {
    forEveryCase([&](const nlohmann::json& row, const Moment& moment) {
        const auto parameters = skeleton_->parametersFor(conditionOf(moment.embedding, moment.motion, moment.phases),
                                                         Skeleton::familiesOf(moment.phases));
        const auto expected = numbers(row, "coefficients");
        expectNear(parameters.filter.coefficients, expected, rmsOf(expected), "coefficients");
        EXPECT_NEAR(parameters.filter.logGain, number(row, "log_gain"), tolerance);
    });
}

TEST_F(SkeletonGoldenTest, WhatTheRefiningGraphSeesAgrees) {
    forEveryCase([&](const nlohmann::json& row, const Moment& moment) {
        std::array<float, Skeleton::enteringChannels * segmentSamples> entering{};
        skeleton_->enter(moment, conditionOf(moment.embedding, moment.motion, moment.phases), entering);
        const auto begun = numbers(row, "begun");
        const double scale = rmsOf(begun);
        expectNear(std::span(entering).first<segmentSamples>(), begun, scale, "begun");
        expectNear(std::span(entering).subspan<segmentSamples, segmentSamples>(), numbers(row, "struck"), scale,
                   "struck");
        expectNear(entering, numbers(row, "entering"), scale, "entering");
    });
}

TEST_F(SkeletonGoldenTest, TheConditioningOfTheRefinementAgrees) {
    const auto refining = std::ranges::find(model_.header().tiers, model::TierKind::refine, &model::Tier::kind);
    ASSERT_NE(refining, model_.header().tiers.end());
    const Perceptron conditioning = readConditioning(model_, refining->name);
    forEveryCase([&](const nlohmann::json& row, const Moment& moment) {
        std::vector<float> film(conditioning.outputs());
        conditioning.run(conditionOf(moment.embedding, moment.motion, moment.phases), film);
        const auto expected = numbers(row, "film");
        expectNear(film, expected, rmsOf(expected), "film");
    });
}

}  // namespace
}  // namespace haptoflow::skeleton::testing
