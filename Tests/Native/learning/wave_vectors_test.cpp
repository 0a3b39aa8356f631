#include "learning/wave_vectors.hpp"

#include "learning/made_recording.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace haptoflow::learning {
namespace {

using Json = nlohmann::json;
using testing::MadeMotion;
using testing::MadeRecording;
using testing::MadeSurface;

std::vector<WaveVector> vectorsOf(const recordings::PreparedRecording& recording) {
    model::ModelHeader header;
    header.speedMps.maximum = 1.5;
    return findWaveVectors(recording, findSliding(recording, header));
}

std::vector<WaveVector> vectorsOf(const MadeRecording& made) {
    return vectorsOf(recordings::prepareRecording(made.view()));
}

/// A recording and the vectors that its file states.
struct GoldenCase {
    recordings::PreparedRecording recording;
    std::vector<WaveVector> vectors;
};

GoldenCase readCase(const std::string& name) {
    std::ifstream file(HAPTOFLOW_TEST_GOLDEN_DIR "/wave-vectors/" + name + ".json");
    const Json json = Json::parse(file);
    GoldenCase result;
    for (const Json& stroke : json.at("strokes")) {
        const std::array<float, 3> motion{stroke.at("velocity_mps")[0].get<float>(),
                                          stroke.at("velocity_mps")[1].get<float>(),
                                          json.at("force_newtons").get<float>()};
        result.recording.motion.insert(result.recording.motion.end(), stroke.at("samples").get<std::size_t>(), motion);
    }
    for (const Json& value : json.at("wave")) {
        result.recording.wave.push_back(json.at("scale_mps2").get<float>() * value.get<float>());
    }
    result.recording.isUsable.assign(result.recording.wave.size(), 1);
    for (const Json& vector : json.at("wave_vectors_per_mm")) {
        result.vectors.push_back({.x = vector[0].get<double>(), .y = vector[1].get<double>()});
    }
    return result;
}

void expectWithin(const std::vector<WaveVector>& found, const std::vector<WaveVector>& expected, double share) {
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
        EXPECT_LT(std::hypot(found[i].x - expected[i].x, found[i].y - expected[i].y),
                  share * std::hypot(expected[i].x, expected[i].y))
            << "vector " << i << " is (" << found[i].x << ", " << found[i].y << ")";
    }
}

TEST(WaveVectorsTest, TheVectorsOfTheGoldenRecordingsEqualThoseOfTheirFilesWithinTwoPerMille) {
    for (const auto& [name, count] : {std::pair{"corduroy", 1U}, {"jute", 2U}, {"sandpaper", 0U}}) {
        SCOPED_TRACE(name);
        const GoldenCase golden = readCase(name);
        ASSERT_EQ(golden.vectors.size(), count);
        ASSERT_EQ(golden.recording.motion.size(), golden.recording.wave.size());
        expectWithin(vectorsOf(golden.recording), golden.vectors, 0.002);
    }
}

TEST(WaveVectorsTest, NoWindowContainsAnUnusableSample) {
    GoldenCase golden = readCase("corduroy");
    constexpr std::size_t first = 5000;
    constexpr std::size_t count = 900;
    std::fill_n(golden.recording.isUsable.begin() + first, count, std::uint8_t{0});
    // Invalid samples, which must have no effect.
    std::fill_n(golden.recording.wave.begin() + first, count, 1e6F);
    const GoldenCase whole = readCase("corduroy");
    expectWithin(vectorsOf(golden.recording), whole.vectors, 0.01);
    golden.recording.wave[first] = std::numeric_limits<float>::quiet_NaN();
    expectWithin(vectorsOf(golden.recording), whole.vectors, 0.01);
}

TEST(WaveVectorsTest, ARecordingOfShortUsableStretchesHasNoWaveVectorsAndDoesNotFail) {
    GoldenCase golden = readCase("corduroy");
    for (std::size_t i = 0; i < golden.recording.isUsable.size(); i += 150) {
        golden.recording.isUsable[i] = 0;
    }
    EXPECT_TRUE(vectorsOf(golden.recording).empty());
}

TEST(WaveVectorsTest, ASurfaceWithoutRibsHasNoWaveVectorsWhateverItsResonance) {
    const MadeMotion usual;
    const MadeMotion aMinute{.seconds = 60.0, .minimumSpeedMps = 0.05};
    for (const auto& [motion, resonancesHz] :
         {std::pair{usual, std::vector{40.0, 90.0, 180.0, 400.0}}, {aMinute, {25.0, 30.0}}}) {
        for (const double resonanceHz : resonancesHz) {
            for (const unsigned seed : {1U, 2U, 3U}) {
                EXPECT_TRUE(vectorsOf(MadeRecording({.resonanceHz = resonanceHz}, motion, 4000.0, seed)).empty())
                    << resonanceHz << " Hz for " << motion.seconds << " s, seed " << seed;
            }
        }
    }
}

TEST(WaveVectorsTest, AConstantSpeedGivesNoWaveVectors) {
    const MadeSurface surface{.ribs = {0.8, 0.0}};
    const MadeMotion motion{.minimumSpeedMps = 0.08, .maximumSpeedMps = 0.08, .cycles = false};
    EXPECT_TRUE(vectorsOf(MadeRecording(surface, motion)).empty());
}

TEST(WaveVectorsTest, StrokesInOneDirectionGiveThePitchAlongIt) {
    const MadeSurface surface{.ribs = {0.8, 0.0}, .ribShare = 0.5};
    const std::vector<WaveVector> found = vectorsOf(MadeRecording(surface, {.cycles = false}));
    ASSERT_FALSE(found.empty());
    EXPECT_NEAR(found[0].x, 0.8, 0.016);
}

TEST(MaterialFrameTest, TheMostDistinctRibsAreAcrossTheFirstAxisAndTheSecondVectorPointsUpward) {
    const std::vector<WaveVector> vectors{{.x = 0.0, .y = 0.8}, {.x = 0.5, .y = 0.0}};
    const MaterialFrame frame = MaterialFrame::across(vectors);
    EXPECT_NEAR(frame.turnRadians, 0.5 * std::numbers::pi, 1e-12);
    EXPECT_EQ(frame.waveNumbers, (std::array<float, 4>{0.8F, 0.0F, 0.0F, 0.5F}));
}

TEST(MaterialFrameTest, ARotatedMotionCrossesTheSameNumberOfRibsAndKeepsItsForce) {
    const std::vector<WaveVector> vectors{{.x = 0.6, .y = -0.45}};
    const MaterialFrame frame = MaterialFrame::across(vectors);
    recordings::PreparedRecording recording;
    recording.motion = {{0.08F, 0.03F, 1.5F}};
    frame.turn(recording);
    const std::array<float, 3>& turned = recording.motion[0];
    EXPECT_NEAR(frame.waveNumbers[0] * turned[0] + frame.waveNumbers[1] * turned[1], 0.6 * 0.08 - 0.45 * 0.03, 1e-7);
    EXPECT_NEAR(recording.speedMps(0), std::hypot(0.08, 0.03), 1e-7);
    EXPECT_EQ(turned[2], 1.5F);
}

TEST(MaterialFrameTest, ZeroVectorsAreSkippedAndWithoutRibsTheMotionIsNotRotated) {
    const std::vector<WaveVector> vectors{{.x = 0.0, .y = 0.0}, {.x = 0.0, .y = 0.5}};
    EXPECT_EQ(MaterialFrame::across(vectors).waveNumbers, (std::array<float, 4>{0.5F, 0.0F, 0.0F, 0.0F}));
    const MaterialFrame frame = MaterialFrame::across(std::span(vectors).first(1));
    EXPECT_EQ(frame.turnRadians, 0.0);
    EXPECT_EQ(frame.waveNumbers, (std::array<float, 4>{}));
}

}  // namespace
}  // namespace haptoflow::learning
