#include "engine/quality_control.hpp"

#include "engine/material_library.hpp"
#include "small_library.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace haptoflow::engine {
namespace {

constexpr double budgetMs = 3.0;

/// A control with three tiers in an order of accuracy, measured at these times in milliseconds.
QualityControl measuredControl(double first, double second, double third,
                               std::vector<std::size_t> byAccuracy = {0, 1, 2}) {
    QualityControl control(3, {.fixedTier = std::nullopt, .budgetMs = budgetMs}, 1, std::move(byAccuracy));
    const std::array<double, 3> times{first, second, third};
    while (const auto tier = control.tierToMeasure()) {
        control.recordMeasurement(*tier, times.at(*tier));
    }
    return control;
}

void runRounds(QualityControl& control, int rounds, double milliseconds, std::size_t voices = 1) {
    for (int round = 0; round < rounds; ++round) {
        control.recordRound(milliseconds, voices, voices);
    }
}

TEST(RunTimesTest, PercentilesCoverOnlyTheLastRuns) {
    RunTimes times;
    EXPECT_EQ(times.percentile(0.99), 0.0);
    for (int run = 1; run <= 100; ++run) {
        times.add(run);
    }
    EXPECT_EQ(times.percentile(0.5), 50.0);
    EXPECT_EQ(times.percentile(0.99), 99.0);
    for (int run = 0; run < 128; ++run) {
        times.add(7.0);
    }
    EXPECT_EQ(times.percentile(0.99), 7.0) << "the first hundred runs no longer count";
}

TEST(QualityControlTest, TheMostAccurateTierThatFitsTheBudgetIsChosen) {
    EXPECT_EQ(measuredControl(0.2, 0.5, 1.5).tier(), 2U);
    EXPECT_EQ(measuredControl(0.2, 0.5, 3.5).tier(), 1U);
    EXPECT_EQ(measuredControl(2.0, 4.0, 8.0).tier(), 0U);
    EXPECT_EQ(measuredControl(20.0, 40.0, 80.0).tier(), 0U) << "a machine that is too slow gets the fastest tier";
}

TEST(QualityControlTest, EachTierIsMeasuredTwentyTimesBeforeTheFirstDecision) {
    QualityControl control(2, {.fixedTier = std::nullopt, .budgetMs = budgetMs}, 0);
    int runs = 0;
    while (const auto tier = control.tierToMeasure()) {
        EXPECT_EQ(control.tier(), 0U);
        control.recordMeasurement(*tier, 0.1);
        ++runs;
    }
    EXPECT_EQ(runs, 40);
    EXPECT_EQ(control.tier(), 1U);
}

TEST(QualityControlTest, OnlyThreeOverrunsCloseTogetherCauseAStepDown) {
    QualityControl control = measuredControl(0.2, 0.5, 1.5);
    for (int i = 0; i < 20; ++i) {
        runRounds(control, 40, 1.5);
        control.recordRound(9.0, 1, 1);
    }
    EXPECT_EQ(control.tier(), 2U);
    runRounds(control, 3, 9.0);
    EXPECT_EQ(control.tier(), 1U);
    EXPECT_EQ(control.stepsDown(), 1U);
}

TEST(QualityControlTest, AStepUpNeedsALongTimeWithoutOverrunsThatGrowsWithEachStepDown) {
    QualityControl control = measuredControl(0.2, 0.5, 1.5);
    const auto quietRoundsUntilUp = [&control] {
        runRounds(control, 3, 9.0);
        const std::size_t fallen = control.tier();
        int rounds = 0;
        while (control.tier() == fallen && rounds < 100000) {
            control.recordRound(0.5, 1, 1);
            ++rounds;
        }
        return rounds;
    };
    const int first = quietRoundsUntilUp();
    const int second = quietRoundsUntilUp();
    EXPECT_GE(first, 72 * 5);
    EXPECT_GE(second, 2 * first - 2);
    EXPECT_EQ(control.stepsUp(), 2U);
}

TEST(QualityControlTest, NoStepUpOccursToATierThatDoesNotFitAllVoices) {
    QualityControl control = measuredControl(0.2, 0.5, 1.5);
    runRounds(control, 3, 9.0, 4);
    ASSERT_EQ(control.tier(), 1U);
    runRounds(control, 5000, 2.0, 4);
    EXPECT_EQ(control.tier(), 1U) << "four voices at 1.5 ms exceed the budget";
    runRounds(control, 5000, 0.5, 1);
    EXPECT_EQ(control.tier(), 2U);
}

TEST(QualityControlTest, AdditionalVoicesCauseAStepDownBeforeAnOverrun) {
    QualityControl control = measuredControl(0.2, 0.5, 1.5);
    ASSERT_EQ(control.tier(), 2U);
    control.recordRound(1.5, 1, 1);
    EXPECT_EQ(control.tier(), 2U);
    control.recordRound(2.5, 3, 3);
    EXPECT_EQ(control.tier(), 1U) << "three voices at 1.5 ms exceed 3 ms";
    control.recordRound(2.5, 12, 12);
    EXPECT_EQ(control.tier(), 0U) << "twelve voices at 0.5 ms exceed 3 ms";
}

TEST(QualityControlTest, ARoundOfSeveralSegmentsForOneVoiceIsTimedBySegment) {
    QualityControl control = measuredControl(0.2, 0.5, 0.7);
    // A fast stroke, or a blend of four labels: 2.8 ms are within the budget.
    for (int round = 0; round < 200; ++round) {
        control.recordRound(2.8, 1, 4);
    }
    EXPECT_NEAR(control.times(2).percentile(0.99), 0.7, 1e-6);
    control.recordRound(1.4, 2, 2);
    EXPECT_EQ(control.tier(), 2U) << "two voices at 0.7 ms fit; at 2.8 ms they would not";
    EXPECT_EQ(control.stepsDown(), 0U);
}

/// The same with a third tier that is less accurate than the second.
QualityControl controlByAccuracy(double first, double second, double third) {
    return measuredControl(first, second, third, {0, 2, 1});
}

TEST(QualityControlTest, TheOrderOfAccuracyDecidesAndNotTheModelsOrder) {
    EXPECT_EQ(controlByAccuracy(0.2, 0.5, 1.5).tier(), 1U);
    EXPECT_EQ(controlByAccuracy(0.2, 3.5, 1.5).tier(), 2U)
        << "the most accurate tier does not fit, so the second most accurate is chosen";
    EXPECT_EQ(controlByAccuracy(0.2, 3.5, 3.5).tier(), 0U);
}

TEST(QualityControlTest, AStepDownSkipsTiersThatAreNotFaster) {
    QualityControl control = controlByAccuracy(0.2, 0.5, 1.5);
    runRounds(control, 3, 9.0);
    EXPECT_EQ(control.tier(), 0U) << "the tier between them is slower than the present one";
    EXPECT_EQ(control.stepsDown(), 1U);
    runRounds(control, 100, 9.0);
    EXPECT_EQ(control.tier(), 0U);
    EXPECT_EQ(control.stepsDown(), 1U);
}

TEST(QualityControlTest, AStepUpSkipsATierThatIsSlowerAndLessAccurateThanAnother) {
    QualityControl control = controlByAccuracy(0.2, 0.5, 1.5);
    runRounds(control, 3, 9.0);
    ASSERT_EQ(control.tier(), 0U);
    runRounds(control, 6000, 0.2);
    EXPECT_EQ(control.tier(), 1U);
    EXPECT_EQ(control.stepsUp(), 1U);
}

TEST(QualityControlTest, TiersAreComparedByTimesMeasuredUnderTheSameLoad) {
    QualityControl control = measuredControl(0.2, 0.5, 3.5);
    ASSERT_EQ(control.tier(), 1U);
    runRounds(control, 3, 9.0);
    ASSERT_EQ(control.tier(), 0U);
    // Another program slows the fast tier down until all its stored times are affected, and then stops.
    runRounds(control, 128, 1.9);
    runRounds(control, 800, 0.2);
    ASSERT_EQ(control.tier(), 1U);
    runRounds(control, 3, 9.0);
    EXPECT_EQ(control.tier(), 0U);
}

TEST(QualityControlTest, AnInvalidOrderOfAccuracyIsRejected) {
    for (const std::vector<std::size_t>& order : {std::vector<std::size_t>{0, 1}, {0, 1, 1}, {0, 1, 3}, {0, 1, 2, 3}}) {
        EXPECT_THROW(QualityControl(3, {.fixedTier = 0, .budgetMs = budgetMs}, 0, order), std::invalid_argument);
    }
}

TEST(QualityControlTest, TheQualityCanBeChangedAtAnyTime) {
    QualityControl control = measuredControl(0.2, 0.5, 1.5);
    control.setSettings({.fixedTier = 0, .budgetMs = budgetMs});
    EXPECT_EQ(control.tier(), 0U);
    control.setSettings({.fixedTier = std::nullopt, .budgetMs = budgetMs});
    EXPECT_EQ(control.tier(), 2U);
    EXPECT_THROW(QualityControl(3, {.fixedTier = 3, .budgetMs = budgetMs}, 0), std::invalid_argument);
}

TEST(LeadEstimatorTest, OneStallDoesNotLengthenTheLeadButTwoDo) {
    LeadEstimator lead;
    EXPECT_EQ(lead.samples(11), 30) << "without observations two blocks and 4 ms";
    for (int i = 0; i < 200; ++i) {
        lead.observe(12);
    }
    EXPECT_EQ(lead.samples(11), 13);
    lead.observe(60);
    EXPECT_EQ(lead.samples(11), 13);
    lead.observe(60);
    EXPECT_EQ(lead.samples(11), 61);
    for (int i = 0; i < 128; ++i) {
        lead.observe(12);
    }
    EXPECT_EQ(lead.samples(11), 13) << "the stalls no longer count";
}

TEST(LeadEstimatorTest, TheLeadIsAtLeastABlockAndAtMostFiftyMilliseconds) {
    LeadEstimator lead;
    for (int i = 0; i < 200; ++i) {
        lead.observe(0);
    }
    EXPECT_EQ(lead.samples(43), 43);
    EXPECT_EQ(lead.samples(400), 100);
}

/// Levels like those of a level graph: powers of speed and force with a variation over direction.
double level(double vx, double vy, double newtons, double first) {
    const double speed = std::hypot(vx, vy);
    const double along = std::cos(2.0 * std::atan2(vy, vx));
    return (0.5 + first) * std::pow(speed, 0.7) * std::pow(newtons, 0.4) * std::exp(0.2 * along);
}

class PowerLaw final : public inference::SegmentGenerator {
public:
    void generate(std::span<const inference::SegmentRequest>, std::span<float>) override {}
    void levels(std::span<const inference::SegmentRequest> requests, std::span<float> levelsMps2) override {
        ++calls;
        requestCount += requests.size();
        if (whenAsked) {
            whenAsked();
        }
        for (std::size_t i = 0; i < requests.size(); ++i) {
            const auto& motion = requests[i].motion;
            levelsMps2[i] = static_cast<float>(
                level(motion[0], motion[1], motion[2], static_cast<double>(std::abs(requests[i].embedding[3]))));
        }
    }

    std::size_t calls = 0;
    std::size_t requestCount = 0;
    std::function<void()> whenAsked;
};

/// The small model with `labels` labels that share `embeddings` embeddings.
model::ModelFile modelWithLabels(std::size_t labels, std::size_t embeddings) {
    model::testing::ModelBuilder builder;
    const nlohmann::json first = builder.header["labels"][0];
    for (std::size_t label = 2; label < labels; ++label) {
        nlohmann::json next = first;
        next["name"] = "label " + std::to_string(label);
        next["embedding_row"] = label % embeddings;
        builder.header["labels"].push_back(next);
    }
    std::vector<float> rows(embeddings * model::embeddingSize);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        rows[i] = 0.001F * static_cast<float>(i / model::embeddingSize);
    }
    builder.blobs[0].shape = {static_cast<std::int64_t>(embeddings), model::embeddingSize};
    builder.blobs[0].bytes = model::testing::bytesOf(rows);
    return model::ModelFile::parse(builder.build());
}

/// Number of evaluations of the level graph for a model's levels.
std::size_t levelsAskedFor(std::size_t labels, std::size_t embeddings) {
    PowerLaw graph;
    const model::ModelFile model = modelWithLabels(labels, embeddings);
    const MaterialLibrary library(model, graph);
    EXPECT_LE(graph.calls, graph.requestCount / 256 + 1) << "all calls except the last are full batches";
    return graph.requestCount;
}

double decibels(double ratio) {
    return std::abs(20.0 * std::log10(ratio));
}

class OnsetLevelsTest : public ::testing::Test {
protected:
    [[nodiscard]] double expected(std::size_t label, double vx, double vy, double newtons) const {
        return level(vx, vy, newtons, static_cast<double>(std::abs(model_.embedding(label)[3])));
    }

    model::ModelFile model_ = testing::smallModel();
    PowerLaw graph_;
    /// The level of a blend at a motion.
    [[nodiscard]] float levelOf(std::initializer_list<testing::LabelWeight> entries,
                                const std::array<float, 3>& motion) const {
        return MaterialLibrary::ReadScope(library_).ingredients(testing::blendOf(entries)).levelMps2(motion);
    }
    MaterialLibrary library_{model_, graph_};
};

TEST_F(OnsetLevelsTest, TheTableIsWithinHalfADecibelOfTheGraph) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> share(0.0, 1.0);
    for (int trial = 0; trial < 2000; ++trial) {
        const double speed = 0.01 * std::pow(40.0, share(random));
        const double angle = 2.0 * std::numbers::pi * share(random);
        const double newtons = 0.1 * std::pow(40.0, share(random));
        const double vx = speed * std::cos(angle);
        const double vy = speed * std::sin(angle);
        const float found = levelOf({{.label = 1, .weight = 1.0F}},
                                    {static_cast<float>(vx), static_cast<float>(vy), static_cast<float>(newtons)});
        ASSERT_LT(decibels(static_cast<double>(found) / expected(1, vx, vy, newtons)), 0.5);
    }
}

TEST_F(OnsetLevelsTest, BeyondTheRangeAndAtRestTheLevelIsThatOfTheEdge) {
    const auto oak = [this](const std::array<float, 3>& motion) {
        return levelOf({{.label = 0, .weight = 1.0F}}, motion);
    };
    EXPECT_EQ(oak({0.4F, 0.0F, 4.0F}), oak({4.0F, 0.0F, 400.0F}));
    EXPECT_EQ(oak({0.01F, 0.0F, 0.1F}), oak({0.0F, 0.0F, 0.0F}));
}

TEST(OnsetLevelsCostTest, LabelsWithTheSameEmbeddingNeedNoFurtherEvaluations) {
    EXPECT_EQ(levelsAskedFor(4096, 16), 16U * 640U);
}

TEST(OnsetLevelsCostTest, ACancellationEndsTheTabulationWithinOneBatch) {
    PowerLaw graph;
    const auto cancellation = std::make_shared<inference::Cancellation>();
    graph.whenAsked = [&] {
        if (graph.calls == 3) {
            cancellation->cancel();
        }
    };
    const model::ModelFile model = modelWithLabels(4096, 4096);
    EXPECT_THROW(MaterialLibrary(model, graph, {.cancellation = cancellation}), inference::LoadCancelled);
    EXPECT_EQ(graph.calls, 3U);
}

}  // namespace
}  // namespace haptoflow::engine
