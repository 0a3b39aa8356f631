#include "recordings/recording_reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <span>
#include <sstream>
#include <string>

namespace haptoflow::recordings {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string tableOf(int rows, const std::string& columns = "", const std::string& cells = "") {
    std::ostringstream text;
    text << "time_s,acceleration_mps2" << columns << '\n';
    for (int row = 0; row < rows; ++row) {
        text << 0.001 * row << ',' << std::sin(1.7 * row) << cells << '\n';
    }
    return text.str();
}

GivenFiles given(const std::map<std::string, std::string>& files) {
    std::map<std::string, std::span<const char>> spans;
    for (const auto& [name, bytes] : files) {
        spans.emplace(name, std::span(bytes));
    }
    return GivenFiles(std::move(spans));
}

TEST(GivenFiles, ASidecarAndAMotionFileAreFoundByName) {
    const std::map<std::string, std::string> bytes{
        {"mat.csv", tableOf(500)},
        {"MAT.JSON", R"({"motion": "mat.motion.csv", "label": "mat"})"},
        {"recordings.json", R"({"licence": "CC0 1.0"})"},
        {"mat.motion.csv", "time_s,speed_mps,force_newtons\n0,0.1,1\n0.2,0.1,1\n0.4,0.1,1\n0.6,0.1,1\n"}};
    GivenFiles files = given(bytes);
    const MaterialRecording recording = readMaterialRecording(files, "mat.csv", {});
    EXPECT_EQ(recording.description.label, "mat");
    EXPECT_EQ(recording.description.licence, "CC0 1.0");
    EXPECT_FLOAT_EQ(recording.velocityMps[200], 0.1F);
}

TEST(GivenFiles, ANameWithAFolderLeadsNowhere) {
    const std::map<std::string, std::string> bytes{{"mat.csv", tableOf(500)},
                                                   {"mat.json", R"({"motion": "../up.csv"})"},
                                                   {"../up.csv", "time_s,speed_mps\n0,1\n"}};
    GivenFiles files = given(bytes);
    EXPECT_THAT([&] { (void)readMaterialRecording(files, "mat.csv", {}); },
                ::testing::ThrowsMessage<RecordingUnusable>(HasSubstr("which is outside the folder of mat.json")));
}

TEST(GivenFiles, AFileThatIsNotGivenDoesNotExist) {
    GivenFiles files = given({});
    EXPECT_THAT([&] { (void)readMaterialRecording(files, "mat.csv", {}); },
                ::testing::ThrowsMessage<RecordingUnusable>(HasSubstr("mat.csv: does not exist")));
}

TEST(RecordingWords, FillWhatTheFilesDoNotGive) {
    const std::map<std::string, std::string> bytes{{"mat.csv", tableOf(500, ",speed_mps", ",0.2")}};
    GivenFiles files = given(bytes);
    const MaterialRecording recording = readMaterialRecording(files, "mat.csv", {.speedMps = 0.5, .forceNewtons = 1.5});
    EXPECT_FLOAT_EQ(recording.velocityMps[10], 0.2F) << "the file's own motion counts";
    EXPECT_EQ(recording.constantForceNewtons, 1.5);
    const std::map<std::string, std::string> constants{
        {"mat.csv", tableOf(500)},
        {"recordings.json", R"({"velocity_mps": [0.0, 0.1], "force_newtons": 0.5})"},
        {"mat.json", R"({"speed_mps": 0.2})"}};
    GivenFiles sidecars = given(constants);
    const MaterialRecording constant = readMaterialRecording(sidecars, "mat.csv", {.forceNewtons = 1.5});
    EXPECT_EQ(constant.constantVelocityMps, (std::array{0.2, 0.0})) << "the sidecar replaces the folder's defaults";
    EXPECT_EQ(constant.constantForceNewtons, 1.5) << "and the words replace both";
    const MaterialRecording alone = readMaterialRecording(files, "mat.csv", {});
    EXPECT_THAT([&] { requireMotionAndForce(alone.description, "mat.csv", alone.hasMotion(), alone.hasForce()); },
                ::testing::ThrowsMessage<RecordingUnusable>(HasSubstr("no force in it or beside it")));
}

TEST(DescribedRecording, IsTheSidecarAndTheColumnNamesWithoutTheRows) {
    const std::map<std::string, std::string> bytes{{"mat.csv", "time_s,acceleration_mps2,mood\n0,fine,good\n"},
                                                   {"mat.json", R"({"label": "mat", "motion": "way.csv"})"},
                                                   {"way.csv", "time_s,speed_mps,weather\n0,1,wet\n"}};
    GivenFiles files = given(bytes);
    const RecordingDescription description = describeRecording(files, "mat.csv");
    EXPECT_EQ(description.label, "mat");
    EXPECT_EQ(description.motion, "way.csv");
    EXPECT_THAT(description.notes, ElementsAre("mat.csv: columns mood are not known and are ignored",
                                               "way.csv: columns weather are not known and are ignored"));
}

TEST(Tracks, KeepEachSensorsOwnTimes) {
    const std::map<std::string, std::string> bytes{
        {"mat.csv", tableOf(500)},
        {"mat.json", R"({"motion": "way.csv"})"},
        {"way.csv",
         "time_s,position_x_mm,position_y_mm\n0,0,0\n0.1,10,0\n0.1005,10,0\n0.2,20,0\n0.3,30,0\n0.4,40,0\n"}};
    GivenFiles files = given(bytes);
    const MaterialRecording recording = readMaterialRecording(files, "mat.csv", {});
    EXPECT_EQ(recording.tracks.acceleration.count(), 500U);
    EXPECT_TRUE(recording.tracks.hasPositions);
    EXPECT_EQ(recording.tracks.motion.count(), 6U) << "so few readings have no period";
    EXPECT_DOUBLE_EQ(recording.tracks.motion.at(3)[0], 0.02);
    EXPECT_EQ(recording.tracks.force.count(), 0U);
}

TEST(Recording, LongerThanFiveMinutesIsLearntFromItsBeginning) {
    std::ostringstream text;
    text << "time_s,acceleration_mps2\n";
    for (int row = 0; row < 310'000; ++row) {
        text << 0.001 * row << ',' << row % 7 << '\n';
    }
    text.precision(9);
    const std::map<std::string, std::string> bytes{{"long.csv", text.str()}, {"long.json", R"({"speed_mps": 0.1})"}};
    GivenFiles files = given(bytes);
    const MaterialRecording recording = readMaterialRecording(files, "long.csv", {});
    EXPECT_EQ(recording.view().sampleCount(), 300'001U);
    EXPECT_EQ(recording.tracks.acceleration.count(), 310'000U);
    EXPECT_THAT(recording.description.notes, ElementsAre("long.csv: only the first 300 s are learnt from"));
}

}  // namespace
}  // namespace haptoflow::recordings
