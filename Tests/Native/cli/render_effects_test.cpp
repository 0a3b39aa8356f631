#include "command_line.hpp"
#include "output_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace haptoflow::cli {
namespace {

using testing::Finished;
using ::testing::HasSubstr;

class RenderEffectsTest : public testing::CommandLineTest {
protected:
    void SetUp() override {
        CommandLineTest::SetUp();
        // Three taps, each from 2 cm at 0.4 m/s and up again.
        std::string taps = "t,x,y,z\n";
        for (int tap = 0; tap < 3; ++tap) {
            const double begin = 0.4 * tap;
            for (const auto& [time, height] : {std::pair(0.0, 0.021), {0.0525, 0.0}, {0.1, 0.0}, {0.15, 0.021}}) {
                taps += std::to_string(begin + time) + ",0," + std::to_string(height) + ",0\n";
            }
        }
        write("taps.csv", taps);
    }

    [[nodiscard]] nlohmann::json reportOf(const std::string& words) const {
        const Finished rendered = run("render scene.json --report felt.json " + words);
        EXPECT_EQ(rendered.exitCode, 0) << rendered.errors;
        return rendered.exitCode == 0 ? nlohmann::json::parse(read("felt.json")) : nlohmann::json::object();
    }
    [[nodiscard]] std::vector<float> wave(const std::string& name) const {
        return readRecording("the wave", at(name).string()).samples;
    }
};

TEST_F(RenderEffectsTest, ATapIsSilentUnlessItsImpactIsRequested) {
    const nlohmann::json texture = reportOf("--stroke taps.csv -o plain.wav");
    EXPECT_EQ(texture.at("effects"), nlohmann::json::object());
    EXPECT_LT(texture.at("peak").get<double>(), 1e-3);
    const nlohmann::json impact = reportOf("--stroke taps.csv -o struck.wav --effects texture,impact,edge");
    EXPECT_EQ(impact.at("effects").at("impact").at("events"), 3);
    EXPECT_GT(impact.at("effects").at("impact").at("samples"), 1000);
    EXPECT_FALSE(impact.at("effects").contains("edge")) << "an effect without an event does not run";
    EXPECT_GT(impact.at("peak").get<double>(), 0.02);
}

TEST_F(RenderEffectsTest, RequestingTheTextureAloneGivesTheSameBytesAsTheDefault) {
    ASSERT_EQ(run("render scene.json --stroke stroke.csv -o plain.wav").exitCode, 0);
    ASSERT_EQ(run("render scene.json --stroke stroke.csv -o asked.wav --effects texture").exitCode, 0);
    EXPECT_EQ(read("plain.wav"), read("asked.wav"));
    ASSERT_EQ(run("render scene.json --stroke stroke.csv -o flat.wav --actuator flat").exitCode, 0);
    EXPECT_EQ(read("plain.wav"), read("flat.wav")) << "a flat actuator needs no compensation";
}

TEST_F(RenderEffectsTest, TheLastImpactIsRenderedToItsEnd) {
    write("last.csv", "t,x,y,z\n0,0,0.021,0\n0.0525,0,0,0\n0.06,0,0,0\n0.1,0,0.03,0\n");
    ASSERT_EQ(run("render scene.json --stroke last.csv -o struck.wav --effects impact").exitCode, 0);
    const std::vector<float> samples = wave("struck.wav");
    EXPECT_GT(std::ranges::max(samples), 0.01F);
    EXPECT_LT(std::abs(samples.back()), 1e-5F);
}

TEST_F(RenderEffectsTest, ADelayedRenderEqualsTheOriginalShiftedInTime) {
    ASSERT_EQ(run("render scene.json --stroke stroke.csv -o plain.wav").exitCode, 0);
    ASSERT_EQ(run("render scene.json --stroke stroke.csv -o late.wav --delay-ms 100").exitCode, 0);
    const std::vector<float> plain = wave("plain.wav");
    const std::vector<float> late = wave("late.wav");
    ASSERT_GE(late.size(), plain.size() + 4000);
    double difference = 0.0;
    for (std::size_t i = 0; i + 4800 < late.size() && i < plain.size(); ++i) {
        difference = std::max(difference, std::abs(static_cast<double>(late[i + 4800] - plain[i])));
    }
    // The delay is before the limiter's look-ahead and the gates, which open and close at other samples.
    EXPECT_LT(difference, 0.02 * static_cast<double>(std::ranges::max(plain)));
}

TEST_F(RenderEffectsTest, AVoiceCoilIsCompensatedAndReported) {
    const nlohmann::json report = reportOf("--stroke stroke.csv -o coil.wav --actuator voice-coil");
    EXPECT_GT(report.at("effects").at("compensation").at("samples"), 10000);
    ASSERT_EQ(run("render scene.json --stroke stroke.csv -o plain.wav").exitCode, 0);
    EXPECT_NE(read("coil.wav"), read("plain.wav"));
}

TEST_F(RenderEffectsTest, AJsonOutputHasAFrameEveryFiveMillisecondsAndNeedsNoWav) {
    ASSERT_EQ(run("render scene.json --stroke taps.csv -o motor.json --effects impact").exitCode, 0);
    ASSERT_EQ(run("render scene.json --stroke taps.csv -o felt.wav -o both.json --effects impact").exitCode, 0);
    EXPECT_EQ(read("both.json"), read("motor.json"));
    EXPECT_TRUE(exists("felt.wav"));
    const nlohmann::json motor = nlohmann::json::parse(read("motor.json"));
    EXPECT_EQ(motor.at("format"), "haptoflow parametric");
    const nlohmann::json& frames = motor.at("frames");
    ASSERT_GE(frames.size(), 190U);
    for (std::size_t i = 1; i < frames.size(); ++i) {
        const double step = frames[i][0].get<double>() - frames[i - 1][0].get<double>();
        EXPECT_NEAR(step, 0.005, i == 1 ? 0.0016 : 1e-9);
        EXPECT_GE(frames[i][1].get<double>(), 0.0);
        EXPECT_GE(frames[i][2].get<double>(), 60.0);
        EXPECT_LE(frames[i][2].get<double>(), 400.0);
    }
    ASSERT_EQ(motor.at("transients").size(), 3U) << "one for each tap";
    for (int tap = 0; tap < 3; ++tap) {
        const double seconds = motor.at("transients")[static_cast<std::size_t>(tap)][0].get<double>();
        EXPECT_NEAR(seconds, 0.4 * tap + 0.06, 0.02);
    }
}

TEST_F(RenderEffectsTest, TheFramesReportTheErrorOfTheirIntensity) {
    ASSERT_EQ(run("render scene.json --stroke stroke.csv -o motor.json").exitCode, 0);
    const nlohmann::json errors = nlohmann::json::parse(read("motor.json")).at("intensity_error_db");
    for (const char* played : {"frames", "motor_160_hz"}) {
        const nlohmann::json& error = errors.at(played);
        EXPECT_GT(error.at("felt_frames"), 20) << played;
        EXPECT_LT(std::abs(error.at("mean").get<double>()), 3.0) << played;
        EXPECT_LE(std::abs(error.at("mean").get<double>()), error.at("mean_magnitude").get<double>()) << played;
        EXPECT_LE(error.at("mean_magnitude").get<double>(), error.at("p95").get<double>()) << played;
        EXPECT_LT(error.at("p95").get<double>(), 8.0) << played;
    }
}

TEST_F(RenderEffectsTest, WrongOptionsAreRefusedByNameAndLeaveNoFile) {
    const std::size_t before = fileCount();
    const auto expectError = [this](int exitCode, const std::string& words, const std::string& message) {
        const Finished rendered = run("render scene.json --stroke stroke.csv " + words);
        EXPECT_EQ(rendered.exitCode, exitCode) << words << '\n' << rendered.errors;
        EXPECT_THAT(rendered.errors, HasSubstr(message)) << words;
    };
    expectError(2, "-o a.wav --effects bump", "bump");
    expectError(2, "-o a.wav -o b.wav", "give one .wav, .haptic, .ahap, .hjif, .csv and .json at most");
    expectError(2, "-o a.json --rate 44100", "multiple of 2000 Hz");
    expectError(2, "-o a.wav --delay-ms 501", "501");
    expectError(3, "-o a.wav --actuator nowhere.json", "nowhere.json");
    write("profile.json", R"({"name": "x"})");
    expectError(3, "-o a.wav --actuator profile.json", "profile.json: ");
    EXPECT_EQ(fileCount(), before + 1);
}

}  // namespace
}  // namespace haptoflow::cli
