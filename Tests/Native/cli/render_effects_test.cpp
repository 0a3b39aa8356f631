#include "command_line.hpp"
#include "headless/command_files.hpp"
#include "output_file.hpp"
#include "scene_reliefs.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <lodepng.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
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

TEST_F(RenderEffectsTest, AVoiceCoilIsCompensatedAndReported) {
    const nlohmann::json report = reportOf("--stroke stroke.csv -o coil.wav --actuator voice-coil");
    EXPECT_GT(report.at("effects").at("compensation").at("samples"), 10000);
    ASSERT_EQ(run("render scene.json --stroke stroke.csv -o plain.wav").exitCode, 0);
    EXPECT_NE(read("coil.wav"), read("plain.wav"));
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
    // The two differ a little: the delay comes before limiter and gates, and a gate opens and closes at other samples.
    EXPECT_LT(difference, 0.02 * static_cast<double>(std::ranges::max(plain)));
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
    expectRefusals(
        {
            {"--effects bump", 2, "bump"},
            {"-o b.wav", 2, "give one .wav, .haptic, .ahap, .hjif, .csv and .json at most"},
            {"--delay-ms 501", 2, "501"},
            {"--actuator nowhere.json", 3, "nowhere.json"},
        },
        "render scene.json --stroke stroke.csv -o a.wav ");
}

class SceneReliefsTest : public testing::CommandLineTest {
protected:
    static constexpr unsigned columns = 64;
    static constexpr unsigned rows = 32;

    /// Writes a PNG file of grey (one number of 0 to 1 for each texel) or colours.
    void writeImage(const std::string& name, LodePNGColorType kind, unsigned bits, std::size_t channels,
                    const std::function<double(unsigned column, unsigned row, std::size_t channel)>& value) {
        std::vector<unsigned char> pixels;
        for (unsigned row = 0; row < rows; ++row) {
            for (unsigned column = 0; column < columns; ++column) {
                for (std::size_t channel = 0; channel < channels; ++channel) {
                    const auto number = static_cast<unsigned>(
                        std::lround(value(column, row, channel) * (bits == 16 ? 65535.0 : 255.0)));
                    if (bits == 16) {
                        pixels.push_back(static_cast<unsigned char>(number >> 8U));
                    }
                    pixels.push_back(static_cast<unsigned char>(number & 255U));
                }
            }
        }
        unsigned char* encoded = nullptr;
        std::size_t size = 0;
        ASSERT_EQ(lodepng_encode_memory(&encoded, &size, pixels.data(), columns, rows, kind, bits), 0U);
        write(name, std::string(reinterpret_cast<const char*>(encoded), size));
        std::free(encoded);
    }
    static double wave(unsigned column, double turn = 0.0) {
        return std::sin(2.0 * std::numbers::pi * (column + 0.5) / 16.0 + turn);
    }
    void writeScene(const std::string& relief) {
        write("scene.json", R"({"surfaces": [{"name": "floor", "shape": {"plane": {}}, "material": "wood")" + relief +
                                R"(}], "stylus": {"tip_radius": 0.0001}})");
        std::string stroke = "t,x,y,z,force\n";
        for (int row = 0; row < 250; ++row) {
            stroke += std::to_string(0.004 * row) + "," + std::to_string(0.0004 * row) + ",-0.001,0.01,2\n";
        }
        write("stroke.csv", stroke);
    }
    double levelOf(const std::string& relief) {
        writeScene(relief);
        const Finished done =
            run("render scene.json --stroke stroke.csv -o out.wav --report out.json --effects none --quality sketch "
                "--model '" HAPTOFLOW_TEST_DEFAULT_MODEL "'");
        EXPECT_EQ(done.exitCode, 0) << done.errors;
        return nlohmann::json::parse(read("out.json")).at("rms_mps2").get<double>();
    }
    std::string refusalOf(const std::string& relief) {
        writeScene(relief);
        const Finished done =
            run("render scene.json --stroke stroke.csv -o out.wav --model '" HAPTOFLOW_TEST_DEFAULT_MODEL "'");
        EXPECT_EQ(done.exitCode, 3);
        return done.errors;
    }
};

TEST_F(SceneReliefsTest, HeightsOfEightAndSixteenBitsAndNormalsOfTheSameWavesSoundAlike) {
    writeImage("heights.png", LCT_GREY, 16, 1,
               [](unsigned column, unsigned, std::size_t) { return 0.5 + 0.5 * wave(column); });
    writeImage("coarse.png", LCT_GREY, 8, 1,
               [](unsigned column, unsigned, std::size_t) { return 0.5 + 0.5 * wave(column); });
    writeImage("normals.png", LCT_RGB, 8, 3, [](unsigned column, unsigned, std::size_t channel) {
        const double slope = 0.4 * wave(column, 0.5 * std::numbers::pi);
        const std::array<double, 3> normal{-slope, 0.0, 1.0};
        return 0.5 + 0.5 * normal[channel] / std::hypot(slope, 1.0);
    });
    const std::string rest = R"(, "size": [0.016, 0.008], "depth": 0.0001})";
    const double heights = levelOf(R"(, "relief": {"image": "heights.png")" + rest);
    EXPECT_GT(heights, 1.0);
    EXPECT_NEAR(levelOf(R"(, "relief": {"image": "coarse.png")" + rest) / heights, 1.0, 0.05);
    EXPECT_NEAR(levelOf(R"(, "relief": {"normals": "normals.png")" + rest) / heights, 1.0, 0.12);
    EXPECT_EQ(levelOf(""), 0.0);
}

TEST_F(SceneReliefsTest, TheRowsOfAnImageLeadAlongTheSecondAxisAndGreenNormalsAgainstIt) {
    writeImage("ramp.png", LCT_GREY, 16, 1,
               [](unsigned, unsigned row, std::size_t) { return row < rows / 2 ? 1.0 : 0.0; });
    const headless::SceneRelief relief{.image = "ramp.png", .sizeMetres = {0.1, 0.1}, .depthMetres = 0.001};
    const effects::ReliefMap map = readRelief(relief, 0.0, at("scene.json").string());
    EXPECT_NEAR(map.heightMetres({0.5, 0.25}), 0.001, 1e-6);
    EXPECT_NEAR(map.heightMetres({0.5, 0.75}), 0.0, 1e-6);

    // Highest at the image's rim: down from there the normals lean down, which is less green.
    writeImage("waves.png", LCT_RGB, 8, 3, [](unsigned, unsigned row, std::size_t channel) {
        const double slope = 0.4 * std::sin(2.0 * std::numbers::pi * (row + 0.5) / rows);
        const std::array<double, 3> normal{0.0, -slope, 1.0};
        return 0.5 + 0.5 * normal[channel] / std::hypot(slope, 1.0);
    });
    const headless::SceneRelief waves{
        .image = "waves.png", .isNormalMap = true, .sizeMetres = {0.1, 0.1}, .depthMetres = 0.001};
    const effects::ReliefMap integrated = readRelief(waves, 0.0, at("scene.json").string());
    EXPECT_NEAR(integrated.heightMetres({0.5, 0.0}), 0.001, 2e-5);
    EXPECT_NEAR(integrated.heightMetres({0.5, 0.5}), 0.0, 2e-5);
}

TEST_F(SceneReliefsTest, AnImageThatCannotBeReadIsNamed) {
    const auto relief = [](const std::string& image) {
        return R"(, "relief": {"image": ")" + image + R"(", "size": [0.1, 0.1], "depth": 0.001})";
    };
    EXPECT_THAT(refusalOf(relief("missing.png")), HasSubstr("missing.png"));
    write("text.png", "no image");
    EXPECT_THAT(refusalOf(relief("text.png")), HasSubstr("text.png: not a PNG file"));
    writeImage("whole.png", LCT_GREY, 8, 1, [](unsigned, unsigned, std::size_t) { return 0.5; });
    write("cut.png", read("whole.png").substr(0, 60));
    EXPECT_THAT(refusalOf(relief("cut.png")), HasSubstr("cut.png: damaged"));
}

}  // namespace
}  // namespace haptoflow::cli
