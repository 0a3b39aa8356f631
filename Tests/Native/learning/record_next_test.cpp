#include "learning/sliding.hpp"

#include "learning/learner.hpp"
#include "learning/made_recording.hpp"
#include "model/material_file.hpp"
#include "support/model_generator.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace haptoflow::learning {
namespace {

using ::testing::HasSubstr;

Sliding slidingOf(std::array<double, 3> speeds, std::array<double, 3> forces, double seconds) {
    Sliding sliding;
    sliding.speedMps = speeds;
    sliding.forceNewtons = forces;
    sliding.seconds = seconds;
    return sliding;
}

TEST(RecordNextTest, TheWidestGapIsNamedAndAFullRecordingNeedsNothing) {
    const ExponentPrior prior;
    EXPECT_THAT(recordNext(slidingOf({0.02, 0.05, 0.09}, {0.3, 1.0, 2.0}, 30.0), prior),
                HasSubstr("faster strokes, up to 300 mm/s: above 90 mm/s"));
    EXPECT_THAT(recordNext(slidingOf({0.1, 0.15, 0.3}, {0.3, 1.0, 2.0}, 30.0), prior),
                HasSubstr("slower strokes, down to 20 mm/s: below 100 mm/s"));
    EXPECT_THAT(recordNext(slidingOf({0.02, 0.1, 0.3}, {0.3, 0.4, 0.5}, 30.0), prior), HasSubstr("press harder"));
    EXPECT_THAT(recordNext(slidingOf({0.02, 0.1, 0.3}, {1.5, 1.7, 2.0}, 30.0), prior), HasSubstr("press less"));
    EXPECT_THAT(recordNext(slidingOf({0.02, 0.1, 0.3}, {0.3, 1.0, 2.0}, 8.0), prior), HasSubstr("more of the same"));
    EXPECT_EQ(recordNext(slidingOf({0.018, 0.1, 0.32}, {0.28, 1.0, 2.1}, 30.0), prior), "");
}

TEST(RecordNextTest, WhatIsAdvisedGainsMoreThanMoreOfTheSame) {
    const model::ModelFile model = model::ModelFile::read(HAPTOFLOW_TEST_DEFAULT_MODEL);
    const auto generator = haptoflow::testing::generatorOf(model, 64);
    // Above 120 mm/s the surface is four times as strong, which nobody can guess from slower strokes.
    const testing::MadeSurface surface{.stepMps = 0.12, .stepGain = 4.0};
    const auto learnt = [&](double seconds, double fastestMps) {
        const testing::MadeRecording made(surface,
                                          {.seconds = seconds, .minimumSpeedMps = 0.03, .maximumSpeedMps = fastestMps});
        return learnMaterial(made.view(), model, *generator, testing::briefSettings(1000));
    };
    const auto errorDb = [&](const LearntMaterial& material) {
        const model::Label label = model::parseMaterial(material.materialJson).label;
        const double found = label.level->logLevel(0.25, 1.0, label.speedLevelExponent);
        const double wanted = surface.levelAtReference * std::pow(0.25 / 0.1, surface.speedExponent) * surface.stepGain;
        return std::abs(decibelsPerNat * (found - std::log(wanted)));
    };
    const LearntMaterial first = learnt(10.0, 0.08);
    ASSERT_THAT(first.report.recordNext, HasSubstr("faster"));
    const double same = errorDb(learnt(20.0, 0.08));
    const double advised = errorDb(learnt(20.0, 0.3));
    EXPECT_GT(errorDb(first), 6.0);
    EXPECT_GT(same, 6.0);
    EXPECT_LT(advised, 3.0);
}

}  // namespace
}  // namespace haptoflow::learning
