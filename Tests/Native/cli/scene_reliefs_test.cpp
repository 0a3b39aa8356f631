#include "scene_reliefs.hpp"

#include "command_line.hpp"
#include "headless/command_files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <lodepng.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <vector>

namespace haptoflow::cli {
namespace {

using testing::Finished;
using ::testing::HasSubstr;

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
                                "}], \"stylus\": {\"tip_radius\": 0.0001}}");
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
