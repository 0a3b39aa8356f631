#include "learning/level_law.hpp"
#include "learning/made_recording.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>

namespace haptoflow::learning {
namespace {

using testing::MadeMotion;
using testing::MadeRecording;
using testing::MadeSurface;

constexpr double decibelsPerNat = 8.685889638065037;

LevelLaw lawOf(const MadeRecording& made, const ExponentPrior& prior = {}) {
    const recordings::PreparedRecording recording = recordings::prepareRecording(made.view());
    model::ModelHeader header;
    header.speedMps.maximum = 1.5;
    return fitLevelLaw(recording, findSliding(recording, header), prior);
}

double errorDb(const LevelLaw& law, const MadeSurface& surface, double speed, double force) {
    const double step = surface.stepMps > 0.0 && speed > surface.stepMps ? surface.stepGain : 1.0;
    const double truth = std::log(surface.levelAtReference * step) + surface.speedExponent * std::log(speed / 0.1) +
                         surface.forceExponent * std::log(force);
    return decibelsPerNat * (law.logLevel(speed, force) - truth);
}

TEST(LevelLawTest, APowerLawIsFoundWithinHalfADecibelAndContinuesBeyondTheRecordedSpeeds) {
    const MadeSurface surface{.speedExponent = 0.7, .forceExponent = 0.35};
    const LevelLaw law = lawOf(MadeRecording(surface, {}));
    for (const double speed : {0.035, 0.06, 0.1, 0.2}) {
        EXPECT_NEAR(errorDb(law, surface, speed, 0.9), 0.0, 0.8) << speed;
    }
    EXPECT_NEAR(law.speedExponent, 0.7, 0.12);
    EXPECT_NEAR(law.table.forceExponent, 0.35, 0.15);
    EXPECT_NEAR(errorDb(law, surface, 0.5, 0.9), 0.0, 2.0);
}

TEST(LevelLawTest, AJumpOf14DecibelsIsFollowedInsideTheRecordedRange) {
    const MadeSurface surface{.stepMps = 0.07, .stepGain = 5.0};
    const LevelLaw law = lawOf(MadeRecording(surface, {}));
    EXPECT_NEAR(errorDb(law, surface, 0.045, 0.8), 0.0, 1.5);
    EXPECT_NEAR(errorDb(law, surface, 0.12, 0.8), 0.0, 1.5);
}

TEST(LevelLawTest, TheLevelIsThePowerAlsoWhereItComesInBursts) {
    recordings::PreparedRecording recording;
    recording.wave.resize(40'000);
    inference::fillStandardNormal({.seed = 2, .voice = 0, .segment = 0}, recording.wave);
    double power = 0.0;
    for (std::size_t i = 0; i < recording.wave.size(); ++i) {
        const bool isLoud = i / 100 % 10 == 0;
        recording.wave[i] *= isLoud ? 4.0F : 1.0F;
        power += std::pow(static_cast<double>(recording.wave[i]), 2.0) / static_cast<double>(recording.wave.size());
    }
    recording.motion.assign(recording.wave.size(), {0.1F, 0.0F, 1.0F});
    recording.isUsable.assign(recording.wave.size(), 1);
    model::ModelHeader header;
    header.speedMps.maximum = 1.5;
    const LevelLaw law = fitLevelLaw(recording, findSliding(recording, header), {});
    EXPECT_NEAR(decibelsPerNat * (law.logLevel(0.1, 1.0) - 0.5 * std::log(power)), 0.0, 0.5);
}

TEST(LevelLawTest, WithOneSpeedTheExponentsAreThoseOfThePrior) {
    MadeRecording made({.speedExponent = 0.0}, {.minimumSpeedMps = 0.08, .maximumSpeedMps = 0.0801});
    const LevelLaw law = lawOf(made, {.speedMean = 0.75, .speedSpread = 0.1, .forceMean = 0.2, .forceSpread = 0.1});
    EXPECT_EQ(law.table.speedsMps.size(), 1U);
    EXPECT_NEAR(law.speedExponent, 0.75, 0.05);
    EXPECT_NEAR(law.table.speedsMps[0], 0.08, 0.002);
}

TEST(LevelLawTest, TheTableIsWithinTheMaterialFilesLimits) {
    const LevelLaw law = lawOf(MadeRecording({}, {.seconds = 60.0, .minimumSpeedMps = 0.006, .maximumSpeedMps = 1.0}));
    EXPECT_LE(law.table.speedsMps.size(), 16U);
    EXPECT_TRUE(std::ranges::is_sorted(law.table.speedsMps));
    EXPECT_EQ(law.table.speedsMps.size(), law.table.logLevels.size());
}

}  // namespace
}  // namespace haptoflow::learning
