#include "recordings/recording_reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <ostream>
#include <span>
#include <sstream>
#include <string>
#include <vector>

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

using nlohmann::json;

struct Answer {
    json content;
};

std::ostream& operator<<(std::ostream& stream, const Answer& answer) {
    return stream << answer.content.at("file").get<std::string>() << ": "
                  << answer.content.at("why").get<std::string>();
}

const std::filesystem::path folder = std::filesystem::path(HAPTOFLOW_TEST_GOLDEN_DIR) / "recordings";

std::vector<Answer> answers() {
    std::vector<Answer> all;
    for (const json& each : json::parse(std::ifstream(folder / "expected.json"))) {
        all.push_back({each});
    }
    return all;
}

MaterialRecording readGolden(const std::string& name) {
    DiskFiles files;
    return readMaterialRecording(files, folder / "files" / name, {});
}

struct Figures {
    std::size_t missing = 0;
    std::vector<double> mean;
    double rms = 0.0;
};

Figures figuresOf(const MaterialRecording& recording) {
    Figures figures{.missing = 0, .mean = std::vector<double>(recording.axisCount), .rms = 0.0};
    const std::size_t count = recording.view().sampleCount();
    const auto at = [&](std::size_t i, std::size_t axis) {
        return static_cast<double>(recording.accelerationMps2[i * recording.axisCount + axis]);
    };
    std::vector<std::size_t> finite;
    for (std::size_t i = 0; i < count; ++i) {
        std::isfinite(at(i, 0)) ? finite.push_back(i) : static_cast<void>(++figures.missing);
    }
    double squares = 0.0;
    for (std::size_t axis = 0; axis < recording.axisCount; ++axis) {
        for (const std::size_t i : finite) {
            figures.mean[axis] += at(i, axis) / static_cast<double>(finite.size());
        }
        for (const std::size_t i : finite) {
            squares += (at(i, axis) - figures.mean[axis]) * (at(i, axis) - figures.mean[axis]);
        }
    }
    figures.rms = std::sqrt(squares / static_cast<double>(finite.size()));
    return figures;
}

/// The mean magnitude, over a range of samples, of a quantity of `width` components. Samples that are not finite are
/// left out.
double meanSize(const std::vector<float>& values, std::size_t width, std::size_t from, std::size_t to) {
    double sum = 0.0;
    double count = 0.0;
    for (std::size_t i = from; i < std::min(to, values.size() / width); ++i) {
        const double size = width == 2 ? std::hypot(static_cast<double>(values[2 * i]), values[2 * i + 1]) : values[i];
        sum += std::isfinite(size) ? size : 0.0;
        count += std::isfinite(size) ? 1.0 : 0.0;
    }
    return sum / count;
}

class GoldenRecordings : public ::testing::TestWithParam<Answer> {};

TEST_P(GoldenRecordings, HasItsOneRightAnswer) {
    const json& answer = GetParam().content;
    const auto file = answer.at("file").get<std::string>();
    if (answer.contains("refused")) {
        std::string message = answer.at("refused").get<std::string>();
        if (message.starts_with("FILE")) {
            message.replace(0, 4, (folder / "files" / file).string());
        }
        EXPECT_THAT([&] { (void)readGolden(file); }, ::testing::ThrowsMessage<RecordingUnusable>(HasSubstr(message)));
        return;
    }
    const MaterialRecording recording = readGolden(file);
    const double rate = answer.at("rate_hz");
    EXPECT_NEAR(recording.rateHz, rate, answer.value("rate_tolerance", 1e-6) * rate);
    EXPECT_EQ(recording.axisCount, answer.at("axes").get<std::size_t>());
    EXPECT_NEAR(static_cast<double>(recording.view().sampleCount()), answer.at("samples").get<double>(),
                answer.value("sample_tolerance", 0.0));
    const Figures figures = figuresOf(recording);
    EXPECT_EQ(figures.missing, answer.at("missing_samples").get<std::size_t>());
    const double rms = answer.at("rms_mps2");
    const double tolerance = answer.value("tolerance", 1e-4) * rms;
    EXPECT_NEAR(figures.rms, rms, tolerance);
    for (std::size_t axis = 0; axis < recording.axisCount; ++axis) {
        EXPECT_NEAR(figures.mean[axis], answer.at("mean_mps2")[axis].get<double>(), tolerance);
    }
    const std::size_t from = answer.value("speed_from", std::size_t{0});
    const std::size_t to = answer.value("speed_to", recording.view().sampleCount());
    ASSERT_EQ(recording.hasMotion(), !answer.at("speed_mps").is_null());
    if (recording.hasMotion()) {
        const double speed = recording.constantVelocityMps
                                 ? std::hypot((*recording.constantVelocityMps)[0], (*recording.constantVelocityMps)[1])
                                 : meanSize(recording.velocityMps, 2, from, to);
        EXPECT_NEAR(speed, answer.at("speed_mps").get<double>(), 0.01 * speed);
    }
    ASSERT_EQ(recording.hasForce(), !answer.at("force_newtons").is_null());
    if (recording.hasForce()) {
        const double force = recording.constantForceNewtons
                                 ? *recording.constantForceNewtons
                                 : meanSize(recording.forceNewtons, 1, 0, recording.view().sampleCount());
        EXPECT_NEAR(force, answer.at("force_newtons").get<double>(), 0.01 * force);
    }
    EXPECT_EQ(recording.description.label, answer.at("label").get<std::string>());
    EXPECT_EQ(recording.description.licence, answer.at("licence").get<std::string>());
    EXPECT_EQ(recording.description.source, answer.at("source").get<std::string>());
    std::string notes;
    for (const std::string& note : recording.description.notes) {
        notes += note + "\n";
    }
    for (const json& note : answer.at("notes")) {
        EXPECT_THAT(notes, HasSubstr(note.get<std::string>()));
    }
    EXPECT_EQ(notes.empty(), answer.at("notes").empty()) << notes;
}

INSTANTIATE_TEST_SUITE_P(All, GoldenRecordings, ::testing::ValuesIn(answers()), [](const auto& tested) {
    auto name = tested.param.content.at("file").template get<std::string>();
    std::ranges::replace_if(
        name, [](char letter) { return letter == '.' || letter == '/'; }, '_');
    return name;
});

}  // namespace
}  // namespace haptoflow::recordings
