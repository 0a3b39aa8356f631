#include "engine/quality_control.hpp"

#include <gtest/gtest.h>

#include <array>
#include <stdexcept>
#include <vector>

namespace haptoflow::engine {
namespace {

constexpr double budgetMs = 3.0;

/// A control with three tiers, measured at these times in milliseconds.
QualityControl measuredControl(double first, double second, double third) {
    QualityControl control(3, {.fixedTier = std::nullopt, .budgetMs = budgetMs}, 1);
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

/// A control with three tiers, of which the third is less accurate than the second, measured at these times in
/// milliseconds.
QualityControl controlByAccuracy(double first, double second, double third) {
    QualityControl control(3, {.fixedTier = std::nullopt, .budgetMs = budgetMs}, 1, {0, 2, 1});
    const std::array<double, 3> times{first, second, third};
    while (const auto tier = control.tierToMeasure()) {
        control.recordMeasurement(*tier, times.at(*tier));
    }
    return control;
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

TEST(LeadEstimatorTest, WithoutObservationsTheLeadIsTwoBlocksAndFourMilliseconds) {
    EXPECT_EQ(LeadEstimator{}.samples(11), 30);
}

TEST(LeadEstimatorTest, OneStallDoesNotLengthenTheLeadButTwoDo) {
    LeadEstimator lead;
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

}  // namespace
}  // namespace haptoflow::engine
