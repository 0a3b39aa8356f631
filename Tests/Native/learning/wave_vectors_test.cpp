#include "learning/wave_vectors.hpp"
#include "learning/made_recording.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace haptoflow::learning {
namespace {

using testing::MadeMotion;
using testing::MadeRecording;
using testing::MadeSurface;

std::vector<WaveVector> vectorsOf(const MadeRecording& made) {
    const PreparedRecording recording = prepareRecording(made.view());
    model::ModelHeader header;
    header.speedMps.maximum = 1.5;
    const Sliding sliding = findSliding(recording, header);
    return findWaveVectors(recording, sliding);
}

TEST(WaveVectorsTest, RibsAreFoundWithinTwoPercentInPitchAndDirection) {
    const MadeSurface surface{.ribs = {0.8, 0.45}, .ribShare = 0.5};
    const std::vector<WaveVector> found = vectorsOf(MadeRecording(surface, {}));
    ASSERT_EQ(found.size(), 1U);
    EXPECT_NEAR(found[0].x, 0.8, 0.016);
    EXPECT_NEAR(found[0].y, 0.45, 0.016);
}

TEST(WaveVectorsTest, TwoFamiliesAreBothFound) {
    const MadeSurface surface{.ribs = {0.9, 0.0}, .otherRibs = {0.1, 0.7}, .ribShare = 0.5};
    std::vector<WaveVector> found = vectorsOf(MadeRecording(surface, {.seconds = 14.0}));
    ASSERT_EQ(found.size(), 2U);
    std::ranges::sort(found, {}, [](const WaveVector& each) { return std::abs(each.y); });
    EXPECT_NEAR(std::abs(found[0].x), 0.9, 0.018);
    EXPECT_NEAR(found[1].y * (found[1].x < 0.0 ? -1.0 : 1.0), 0.7, 0.014);
}

TEST(WaveVectorsTest, ASurfaceWithoutRibsHasNoneWhateverItsResonance) {
    for (const double resonanceHz : {40.0, 90.0, 180.0, 400.0}) {
        for (const unsigned seed : {1U, 2U, 3U}) {
            const MadeRecording made({.resonanceHz = resonanceHz}, {}, 4000.0, seed);
            EXPECT_TRUE(vectorsOf(made).empty()) << resonanceHz << " Hz, seed " << seed;
        }
    }
}

TEST(WaveVectorsTest, AnEvenSpeedDoesNotTellARibFromAResonance) {
    const MadeSurface surface{.ribs = {0.8, 0.0}};
    const MadeMotion motion{.slowestMps = 0.08, .fastestMps = 0.08, .turns = false};
    EXPECT_TRUE(vectorsOf(MadeRecording(surface, motion)).empty());
}

TEST(WaveVectorsTest, StrokesOfOneDirectionGiveThePitchAlongIt) {
    const MadeSurface surface{.ribs = {0.8, 0.0}, .ribShare = 0.5};
    const std::vector<WaveVector> found = vectorsOf(MadeRecording(surface, {.turns = false}));
    ASSERT_FALSE(found.empty());
    EXPECT_NEAR(found[0].x, 0.8, 0.016);
}

}  // namespace
}  // namespace haptoflow::learning
