#include "model/material_tables.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace haptoflow::model {
namespace {

TEST(MaterialTablesTest, APlaceIsInterpolatedOverLogarithmsAndLimitedToTheEnds) {
    const double rising[]{0.01, 0.1, 0.4};
    for (const double value : {-1.0, 0.0, 0.005, 0.01, std::nan("")}) {
        EXPECT_EQ(placeInLog(rising, value).lower, 0U) << value;
        EXPECT_EQ(placeInLog(rising, value).share, 0.0) << value;
    }
    EXPECT_EQ(placeInLog(rising, 0.1).lower, 1U);
    EXPECT_EQ(placeInLog(rising, 0.1).share, 0.0);
    EXPECT_EQ(placeInLog(rising, 0.2).lower, 1U);
    EXPECT_NEAR(placeInLog(rising, 0.2).share, 0.5, 1e-12);
    for (const double value : {0.4, 7.0}) {
        EXPECT_EQ(placeInLog(rising, value).lower, 2U);
        EXPECT_EQ(placeInLog(rising, value).share, 0.0);
    }
}

TEST(MaterialTablesTest, ALevelFollowsTheTableAndPowerLawsBeyondItsSpeedsAndOverForce) {
    const LevelTable table{
        .speedsMps = {0.05, 0.2}, .logLevels = {1.0, 2.0}, .forceNewtons = 0.5, .forceExponent = 0.4};
    EXPECT_DOUBLE_EQ(table.logLevel(0.05, 0.5, 0.9), 1.0);
    EXPECT_DOUBLE_EQ(table.logLevel(0.2, 0.5, 0.9), 2.0);
    const double between = std::sqrt(0.0505 * 0.2005) - 0.0005;
    EXPECT_NEAR(table.logLevel(between, 0.5, 0.9), 1.5, 1e-12);
    EXPECT_NEAR(table.logLevel(0.4, 0.5, 0.9), 2.0 + 0.9 * std::log(0.4005 / 0.2005), 1e-12);
    EXPECT_NEAR(table.logLevel(0.0, 0.5, 0.9), 1.0 + 0.9 * std::log(0.0005 / 0.0505), 1e-12);
    EXPECT_NEAR(table.logLevel(0.05, 1.0, 0.9), 1.0 + 0.4 * std::log(2.0), 1e-12);
    EXPECT_DOUBLE_EQ(table.logLevel(0.05, 0.0, 0.9), table.logLevel(0.05, 0.02, 0.9));
}

TEST(MaterialTablesTest, ALevelOfOneSpeedFollowsAPowerLawInBothDirections) {
    const LevelTable table{.speedsMps = {0.1}, .logLevels = {-1.0}, .forceNewtons = 1.0, .forceExponent = 0.0};
    EXPECT_DOUBLE_EQ(table.logLevel(0.1, 3.0, 1.0), -1.0);
    EXPECT_NEAR(table.logLevel(0.2, 3.0, 1.0), -1.0 + std::log(0.2005 / 0.1005), 1e-12);
    EXPECT_NEAR(table.logLevel(0.02, 3.0, 1.0), -1.0 + std::log(0.0205 / 0.1005), 1e-12);
}

TEST(MaterialTablesTest, AToneIsInterpolatedInDecibelsBetweenFourGains) {
    const ToneTable tone{
        .speedsMps = {0.05, 0.2}, .frequenciesHz = {50.0, 200.0, 800.0}, .gainsDb = {{0.0, 4.0, 6.0}, {2.0, 8.0, 0.0}}};
    EXPECT_DOUBLE_EQ(tone.gainDb(0.05, 1.0, 200.0), 4.0);
    EXPECT_NEAR(tone.gainDb(0.1, 1.0, 200.0), 6.0, 1e-12);
    EXPECT_NEAR(tone.gainDb(0.05, 1.0, 100.0), 2.0, 1e-12);
    EXPECT_NEAR(tone.gainDb(0.1, 1.0, 400.0), 0.5 * (5.0 + 4.0), 1e-12);
    EXPECT_NEAR(tone.rowGainDb(1, 400.0), 4.0, 1e-12);
    EXPECT_DOUBLE_EQ(tone.gainDb(0.0, 1.0, 0.0), 0.0);
    EXPECT_DOUBLE_EQ(tone.gainDb(9.0, 1.0, 1000.0), 0.0);
}

TEST(MaterialTablesTest, AToneOverForceIsInterpolatedBetweenRowsOfBothForces) {
    const ToneTable tone{.speedsMps = {0.05, 0.2},
                         .forcesNewtons = {0.5, 2.0},
                         .frequenciesHz = {50.0, 800.0},
                         .gainsDb = {{0.0, 0.0}, {2.0, 2.0}, {4.0, 4.0}, {10.0, 10.0}}};
    EXPECT_DOUBLE_EQ(tone.gainDb(0.2, 0.5, 100.0), 2.0);
    EXPECT_DOUBLE_EQ(tone.gainDb(0.05, 2.0, 100.0), 4.0);
    EXPECT_NEAR(tone.gainDb(0.1, 1.0, 100.0), 0.25 * (0.0 + 2.0 + 4.0 + 10.0), 1e-12);
    EXPECT_DOUBLE_EQ(tone.gainDb(0.001, 0.0, 100.0), 0.0);
    EXPECT_DOUBLE_EQ(tone.gainDb(9.0, 90.0, 100.0), 10.0);
}

}  // namespace
}  // namespace haptoflow::model
