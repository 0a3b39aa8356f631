#include "recordings/recording_reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <ostream>
#include <string>
#include <vector>

namespace haptoflow::recordings {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

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
