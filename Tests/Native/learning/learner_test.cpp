#include "learning/learner.hpp"

#include "inference/load_limits.hpp"
#include "learning/made_recording.hpp"
#include "learning/tone_fit.hpp"
#include "model/material_file.hpp"
#include "model/model_file.hpp"
#include "support/model_generator.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

namespace haptoflow::learning {
namespace {

using ::testing::HasSubstr;
using testing::MadeRecording;
using ::testing::ThrowsMessage;

/// The shipped model's sketch, which learns in a tenth of the time that its networks take.
class LearnerTest : public ::testing::Test {
protected:
    [[nodiscard]] LearntMaterial learn(const recordings::Recording& recording, const LearningSettings& settings) {
        return learnMaterial(recording, model_, *generator_, settings);
    }

    static LearningSettings brief() { return testing::briefSettings(5000); }

    model::ModelFile model_ = model::ModelFile::read(HAPTOFLOW_TEST_DEFAULT_MODEL);
    std::unique_ptr<inference::TierGenerator> generator_ = haptoflow::testing::generatorOf(model_, 64, "sketch");
};

TEST_F(LearnerTest, TheMaterialIsAMaterialFileOfTheModelsSpace) {
    const MadeRecording made({}, {});
    const LearntMaterial learnt = learn(made.view(), brief());
    const model::MaterialFile material = model::parseMaterial(learnt.materialJson);
    EXPECT_NO_THROW(model::requireSpace(material, model_.header()));
    EXPECT_EQ(material.label.name, "made surface");
    EXPECT_EQ(material.provenance.licence, "unknown");
    EXPECT_EQ(material.provenance.recordings, "made.csv");
    EXPECT_NEAR(material.provenance.seconds, 10.0, 0.5);
    EXPECT_NEAR(material.speedMps[0], 0.03, 0.005);
    EXPECT_NEAR(material.speedMps[1], 0.25, 0.03);
    EXPECT_TRUE(learnt.report.waveVectors.empty());
    EXPECT_FALSE(learnt.report.stoppedEarly);
    // The levels go on beyond what was recorded by the law of the material.
    const LearningReport& report = learnt.report;
    ASSERT_FALSE(report.lawSpeedsMps.empty());
    EXPECT_DOUBLE_EQ(report.lawSpeedsMps.front(), 0.005);
    EXPECT_NEAR(report.lawSpeedsMps.back(), 1.0, 1e-9);
    for (const ForceComparison& force : report.forces) {
        ASSERT_EQ(force.learntMps2.size(), report.lawSpeedsMps.size());
        ASSERT_EQ(force.nearestLabelMps2.size(), report.lawSpeedsMps.size());
        for (std::size_t i = 0; i < report.lawSpeedsMps.size(); ++i) {
            const double speed = report.lawSpeedsMps[i];
            const double wanted = 1.5 * std::pow(speed / 0.1, 0.9) * std::pow(force.forceNewtons, 0.3);
            const double toleranceDb = speed > 0.03 && speed < 0.25 ? 1.5 : 4.0;
            EXPECT_NEAR(20.0 * std::log10(force.learntMps2[i] / wanted), 0.0, toleranceDb) << speed;
            EXPECT_GT(force.nearestLabelMps2[i], 0.0);
        }
    }
}

TEST_F(LearnerTest, EqualSeedsGiveEqualBytesAndAnotherSeedAnotherMaterial) {
    const MadeRecording made({}, {});
    LearningSettings settings = brief();
    const std::string first = learn(made.view(), settings).materialJson;
    EXPECT_EQ(learn(made.view(), settings).materialJson, first);
    settings.seed = 2;
    EXPECT_NE(learn(made.view(), settings).materialJson, first);
}

TEST_F(LearnerTest, AKeptLabelStaysInItsPlaceAndIsGivenTheRecordingsLevelAndTone) {
    const MadeRecording made({}, {});
    LearningSettings settings = brief();
    settings.keptLabel = "corduroy";
    const LearntMaterial learnt = learn(made.view(), settings);
    const model::MaterialFile material = model::parseMaterial(learnt.materialJson);
    const auto& labels = model_.header().labels;
    const auto corduroy = std::ranges::find(labels, "corduroy", &model::Label::name);
    const auto row = model_.embedding(static_cast<std::size_t>(corduroy - labels.begin()));
    for (std::size_t i = 0; i < row.size(); ++i) {
        EXPECT_NEAR(material.embedding[i], row[i], 1e-5F) << i;
    }
    EXPECT_EQ(learnt.report.startLabel, "corduroy");
    EXPECT_EQ(learnt.report.turnDegrees, 0.0);
    EXPECT_EQ(learnt.report.waveVectors.size(), 1U);
    EXPECT_TRUE(material.label.tone.has_value());
    EXPECT_TRUE(material.label.level.has_value());
}

/// As a model whose networks carry the levels themselves: its level graph states their unit.
class OneLevel final : public inference::SegmentGenerator {
public:
    void generate(std::span<const inference::SegmentRequest>, std::span<float>) override { FAIL() << "refused before"; }
    void levels(std::span<const inference::SegmentRequest>, std::span<float> levelsMps2) override {
        std::ranges::fill(levelsMps2, 7.25F);
    }
};

TEST_F(LearnerTest, AModelWithOneLevelForAllLabelsIsRefusedBeforeAnythingIsGenerated) {
    const MadeRecording made({}, {});
    OneLevel generator;
    EXPECT_THAT([&] { (void)learnMaterial(made.view(), model_, generator, brief()); },
                ThrowsMessage<std::invalid_argument>(HasSubstr("gives all its labels one level, 7.25 m/s^2")));
}

TEST_F(LearnerTest, TheFitImprovesOnTheNearestLabelAndTheToneOnTheFit) {
    const MadeRecording made({.resonanceHz = 260.0}, {});
    LearningSettings settings = brief();
    settings.segmentBudget = 14'000;
    const LearningReport report = learn(made.view(), settings).report;
    EXPECT_LT(report.fittedDistanceDb, report.startDistanceDb);
    EXPECT_LT(report.spectralDistanceDb, 1.8);
    EXPECT_LT(report.levelErrorDb, 1.0);
    EXPECT_GT(report.generations, 5U);
}

TEST_F(LearnerTest, RibsAreAcrossTheMaterialsFirstAxisAndMakeItPeriodicAndTheReportHasThemAtEachForceAndSpeed) {
    const MadeRecording made({.ribs = {0.8, 0.45}, .ribShare = 0.5}, {});
    const LearntMaterial learnt = learn(made.view(), brief());
    const model::MaterialFile material = model::parseMaterial(learnt.materialJson);
    const double length = std::hypot(0.8, 0.45);
    EXPECT_NEAR(material.embedding[60], length, 0.02);
    EXPECT_EQ(material.embedding[61], 0.0F);
    EXPECT_NEAR(learnt.report.turnDegrees, 29.36, 1.0);
    ASSERT_TRUE(material.label.wavelengthMetres.has_value());
    EXPECT_NEAR(*material.label.wavelengthMetres, 1e-3 / length, 3e-5);
    EXPECT_DOUBLE_EQ(material.label.frequencyExponent, 1.0);
    const LearningReport& report = learnt.report;
    ASSERT_EQ(report.forces.size(), 2U) << "the recording's force swings from 0.4 to 1.2 N";
    EXPECT_LT(report.forces[0].forceNewtons, 0.8);
    EXPECT_GT(report.forces[1].forceNewtons, 0.8);
    double frames = 0.0;
    for (const ForceComparison& force : report.forces) {
        EXPECT_NEAR(force.recordedMps[0], 0.03, 0.01);
        EXPECT_NEAR(force.recordedMps[1], 0.25, 0.04);
        ASSERT_GE(force.speeds.size(), 3U);
        for (const ForceComparison::AtSpeed& each : force.speeds) {
            frames += static_cast<double>(each.recorded.frames);
            // The made surface's law, and its partials' power of 0.34 beside the noise's 1.
            const double wanted =
                1.5 * std::pow(each.speedMps / 0.1, 0.9) * std::pow(force.forceNewtons, 0.3) * std::sqrt(1.34);
            EXPECT_NEAR(each.recorded.rmsMps2 / wanted, 1.0, 0.35);
            EXPECT_NEAR(each.recorded.kurtosis.value(), 3.0, 1.2);
            EXPECT_GT(each.learnt.frames, 0U);
            if (each.recorded.ribsDb[0] && each.speedMps > 0.06) {
                EXPECT_NEAR(*each.recorded.ribsDb[0], 10.0 * std::log10(0.34 / 1.34), 2.5);
                EXPECT_LT(each.nearestLabel.ribsDb[0].value(), *each.recorded.ribsDb[0] - 3.0)
                    << "no label has these ribs";
            }
        }
    }
    EXPECT_NEAR(frames * 0.064, report.slidingSeconds, 1.0);
}

TEST_F(LearnerTest, ASurfaceThatStrikesHasMoreImpulsesThanOneThatOnlyRustles) {
    const MadeRecording rustling({}, {.seconds = 20.0});
    MadeRecording striking = rustling;
    for (std::size_t i = 0; i < striking.acceleration.size(); ++i) {
        // 3 ms, twenty times a second.
        striking.acceleration[i] *= i % 200 < 12 ? 6.0F : 1.0F;
    }
    const auto gainOf = [&](const MadeRecording& made) {
        LearningSettings settings = brief();
        settings.segmentBudget = 8000;
        return model::parseMaterial(learn(made.view(), settings).materialJson).label.impulseGain;
    };
    EXPECT_LE(gainOf(rustling), 1.0F);
    EXPECT_GT(gainOf(striking), 1.0F);
}

TEST_F(LearnerTest, GivenWaveVectorsReplaceTheEstimation) {
    const MadeRecording made({.ribs = {0.8, 0.45}, .ribShare = 0.5}, {});
    LearningSettings settings = brief();
    settings.segmentBudget = 1000;
    settings.waveVectors = {{0.5, 0.0, 0.0, 0.25}};
    const model::MaterialFile given = model::parseMaterial(learn(made.view(), settings).materialJson);
    EXPECT_FLOAT_EQ(given.embedding[60], 0.5F);
    EXPECT_FLOAT_EQ(given.embedding[63], 0.25F);
    settings.waveVectors = {{0.0, 0.0, 0.0, 0.0}};
    EXPECT_FALSE(model::parseMaterial(learn(made.view(), settings).materialJson).label.wavelengthMetres.has_value());
}

TEST_F(LearnerTest, AConstantMotionAndAMissingStretchAreLearntWithWarnings) {
    MadeRecording made({}, {.minimumSpeedMps = 0.08, .maximumSpeedMps = 0.08});
    made.velocity.clear();
    made.force.clear();
    made.constantVelocity = {0.08, 0.0};
    made.constantForce = 0.8;
    std::fill_n(made.acceleration.begin() + 10'000, 400, std::numeric_limits<float>::quiet_NaN());
    LearningSettings settings = brief();
    settings.segmentBudget = 2000;
    const LearntMaterial learnt = learn(made.view(), settings);
    EXPECT_THAT(learnt.report.warnings, ::testing::Contains(HasSubstr("the speed hardly changes")));
    EXPECT_THAT(learnt.report.warnings, ::testing::Contains(HasSubstr("was left out"))) << "a missing stretch";
    const model::MaterialFile material = model::parseMaterial(learnt.materialJson);
    EXPECT_GT(material.label.speedLevelExponent, 0.5);
}

TEST_F(LearnerTest, AnUnusualLevelGivesAWarningAndAnImpossibleOneIsRefused) {
    MadeRecording made({}, {});
    const auto scaled = [&](float gain) {
        MadeRecording result = made;
        for (float& value : result.acceleration) {
            value *= gain;
        }
        return result;
    };
    LearningSettings settings = brief();
    settings.segmentBudget = 1000;
    const MadeRecording quiet = scaled(1e-3F);
    EXPECT_THAT(learn(quiet.view(), settings).report.warnings,
                ::testing::Contains(HasSubstr("check the unit or full scale of the acceleration")));
    const MadeRecording absurd = scaled(1e5F);
    EXPECT_THAT([&] { (void)learn(absurd.view(), settings); },
                ThrowsMessage<recordings::RecordingUnusable>(HasSubstr("above every label of the model")));
}

TEST_F(LearnerTest, ACancelledFitEndsAtTheNextGeneration) {
    const MadeRecording made({}, {});
    inference::Cancellation cancellation;
    LearningSettings settings = brief();
    settings.segmentBudget = 1'000'000;
    settings.cancellation = &cancellation;
    int reports = 0;
    settings.progress = [&](double share, const char*) {
        EXPECT_GE(share, 0.0);
        EXPECT_LE(share, 1.0);
        if (share > 0.2 && ++reports == 2) {
            cancellation.cancel();
        }
    };
    EXPECT_THROW((void)learn(made.view(), settings), inference::LoadCancelled);
    EXPECT_EQ(reports, 2);
}

TEST_F(LearnerTest, ATimeLimitEndsTheFitWithItsBestResult) {
    const MadeRecording made({}, {});
    LearningSettings settings = brief();
    settings.segmentBudget = 1'000'000;
    settings.secondsLimit = 0.5;
    const LearntMaterial learnt = learn(made.view(), settings);
    EXPECT_TRUE(learnt.report.stoppedEarly);
    EXPECT_NO_THROW((void)model::parseMaterial(learnt.materialJson));
}

TEST_F(LearnerTest, NamesAndLabelsThatCannotBeAreRefusedBeforeLearning) {
    const MadeRecording made({}, {});
    LearningSettings settings = brief();
    settings.keptLabel = "moon dust";
    EXPECT_THAT([&] { (void)learn(made.view(), settings); },
                ThrowsMessage<std::invalid_argument>(HasSubstr("no label 'moon dust'")));
    for (const std::string& name : {std::string(), std::string("Denim"), std::string(129, 'a'), std::string("\xFF")}) {
        settings.name = name;
        EXPECT_THROW((void)learn(made.view(), settings), std::invalid_argument) << name;
    }
}

}  // namespace
}  // namespace haptoflow::learning
