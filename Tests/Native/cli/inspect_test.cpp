#include "command_line.hpp"
#include "messages.hpp"
#include "model/material_builder.hpp"
#include "option_values.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

namespace haptoflow::cli {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;

using testing::Finished;
using testing::tinyModel;

/// The output of `haptoflow inspect`, including its errors.
Finished inspect(const std::string& words) {
    Finished run = testing::runHaptoFlow("inspect " + words);
    run.output += run.errors;
    return run;
}

TEST(InspectTest, ASkeletonItsTiersAndTheWavesOfLabelsAreShown) {
    const Finished run = inspect(HAPTOFLOW_TEST_GOLDEN_DIR "/model/skeleton.haptoflow");
    EXPECT_EQ(run.exitCode, 0) << run.output;
    EXPECT_THAT(run.output, ContainsRegex("\n  seeds +-\n"));
    for (const char* part : {"skeleton", "9461 weights, 24 hidden units", "stick-slip mm", "1.1", "rib wander turns",
                             "0.12, 0", "sketch", "refine", "standard (default)"}) {
        EXPECT_THAT(run.output, HasSubstr(part));
    }
}

TEST(InspectTest, ProvenanceLabelsAndTiersAreShownAsText) {
    const Finished run = inspect(tinyModel);
    EXPECT_EQ(run.exitCode, 0) << run.output;
    EXPECT_THAT(run.output, ContainsRegex("\n  seeds +2\n"));
    for (const char* part :
         {"tiny\n", "not trained: written by hand for the tests", "all checksums verified", "Labels (2)", "ruled",
          "600", "Tiers (5)", "average-velocity", "standard (default)", "midpoint", "267", "not measured"}) {
        EXPECT_THAT(run.output, HasSubstr(part));
    }
}

TEST(InspectTest, TheHeaderIsPrintedWithSizeAndChecksumAsJson) {
    const Finished run = inspect(tinyModel + " --json");
    ASSERT_EQ(run.exitCode, 0) << run.output;
    const nlohmann::json report = nlohmann::json::parse(run.output);
    EXPECT_EQ(report["header"]["name"], "tiny");
    EXPECT_EQ(report["header"]["tiers"].size(), 5U);
    EXPECT_EQ(report["file"]["bytes"], std::filesystem::file_size(tinyModel));
    EXPECT_EQ(report["file"]["checksums_verified"], true);
    EXPECT_EQ(report["file"]["crc32"].get<std::string>().size(), 8U);
}

TEST(InspectTest, WhatIsNoModelIsRefusedByNameWithTheReason) {
    std::ifstream stream(tinyModel, std::ios::binary);
    std::string damaged((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
    damaged.at(200) = static_cast<char>(damaged[200] ^ 4);
    const auto folder = std::filesystem::temp_directory_path();
    for (const auto& [name, content, reason] :
         {std::tuple{"haptoflow_damaged", damaged, "checksum at byte 24"},
          {"haptoflow_other", std::string("RIFF....WAVEfmt and so on, long enough to be looked at"),
           "not a .haptoflow file"}}) {
        const std::string path = (folder / name).string();
        std::ofstream(path, std::ios::binary) << content;
        const Finished run = inspect(path + " --json");
        EXPECT_EQ(run.exitCode, 3);
        EXPECT_THAT(run.output, ::testing::AllOf(HasSubstr(path), HasSubstr(reason)));
        std::filesystem::remove(path);
    }
    EXPECT_THAT(inspect("/nowhere/a.haptoflow").output, HasSubstr("/nowhere/a.haptoflow: there is no such file"));
    EXPECT_EQ(inspect("").exitCode, 2);
}

/// Sets or removes an environment variable for the duration of a test.
class Environment {
public:
    Environment(const char* name, const std::optional<std::string>& value) : name_(name) {
        if (const char* before = std::getenv(name)) {
            before_ = before;
        }
        apply(value);
    }
    Environment(const Environment&) = delete;
    Environment& operator=(const Environment&) = delete;
    ~Environment() { apply(before_); }

private:
    void apply(const std::optional<std::string>& value) const {
        if (value) {
            setenv(name_, value->c_str(), 1);
        } else {
            unsetenv(name_);
        }
    }

    const char* name_;
    std::optional<std::string> before_;
};

TEST(ModelLocationTest, TheEnvironmentNamesTheModel) {
    const Environment model("HAPTOFLOW_MODEL", tinyModel);
    EXPECT_EQ(findModel(""), tinyModel);
    EXPECT_EQ(readModel(findModel("")).header().name, "tiny");
}

TEST(ModelLocationTest, WhatIsNotFoundOrNoLibraryIsRefusedWithThePlacesAndTheRemedy) {
    struct Missing {
        const char* variable;
        std::optional<std::string> value;
        std::function<void()> find;
        std::vector<std::string> parts;
    };
    // The test program is deeper in the build folder than the command line, so that none of the usual places exists.
    const std::vector<Missing> all{
        {"HAPTOFLOW_MODEL",
         "/nowhere/a.haptoflow",
         [] { (void)findModel(""); },
         {"/nowhere/a.haptoflow", "HAPTOFLOW_MODEL"}},
        {"HAPTOFLOW_ONNXRUNTIME",
         std::nullopt,
         [] { (void)findOnnxRuntime(); },
         {"HAPTOFLOW_ONNXRUNTIME (not set)", "node_modules/com.github.asus4.onnxruntime/Plugins", "`npm ci`",
          "`npm run build`"}},
        {"HAPTOFLOW_ONNXRUNTIME", tinyModel, [] { (void)openRuntime(); }, {"tiny.haptoflow: cannot be loaded"}}};
    for (const auto& [variable, value, find, parts] : all) {
        const Environment environment(variable, value);
        try {
            find();
            ADD_FAILURE() << "no InputError was thrown";
        } catch (const InputError& error) {
            for (const std::string& part : parts) {
                EXPECT_THAT(error.what(), HasSubstr(part));
            }
        }
    }
}

// Material files in scenes, with --material, and in inspect.

using nlohmann::json;
using ::testing::AllOf;

class MaterialCommandTest : public testing::CommandLineTest {
protected:
    void SetUp() override {
        CommandLineTest::SetUp();
        const json golden = json::parse(readFile(HAPTOFLOW_TEST_GOLDEN_DIR "/material/expected.json"));
        space_ = golden.at("spaces").at("default").get<std::string>();
        writeMaterial("denim.haptomaterial");
    }
    static std::string readFile(const std::string& path) {
        std::ifstream file(path, std::ios::binary);
        return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    }
    void writeMaterial(const std::string& name, const std::function<void(json&)>& change = {}) const {
        json material = model::testing::validMaterial(space_);
        if (change) {
            change(material);
        }
        write(name, material.dump());
    }
    void writeScene(const json& material, const json& more = json::object(),
                    const std::string& name = "scene.json") const {
        json surface = {{"name", "floor"}, {"shape", {{"plane", json::object()}}}, {"material", material}};
        surface.update(more);
        write(name, json({{"surfaces", {surface}}}).dump());
    }
    void expectRefused(const std::string& words, const std::string& message) const {
        expectRefusals({{words, 3, message}}, "render scene.json --stroke stroke.csv -o refused.wav ");
    }

    std::string space_;
};

TEST_F(MaterialCommandTest, AMaterialsNameIsFoundInEveryCaseAndFormOfItsAccents) {
    json material = json::parse(read("denim.haptomaterial"));
    material["name"] = "\xC3\xA4hre";
    write("own.haptomaterial", material.dump());
    writeScene("A\xCC\x88HRE");
    EXPECT_EQ(rendered("--material own.haptomaterial").at("labels"), json({"\xC3\xA4hre"}));
    material["name"] = "a\xCC\x88hre";
    write("same.haptomaterial", material.dump());
    expectRefused("--material own.haptomaterial --material same.haptomaterial", "which is already that of a label");
    writeScene("ahre");
    expectRefused("--material own.haptomaterial", "which the model does not know");
}

TEST_F(MaterialCommandTest, AMaterialPathInASceneIsRelativeToTheScene) {
    writeScene("denim.haptomaterial");
    const json report = rendered();
    EXPECT_GT(report.at("rms_mps2").get<double>(), 0.01);
    EXPECT_EQ(report.at("labels"), json({"denim.haptomaterial"}));
    EXPECT_GT(report.at("effects").at("tone").at("samples").get<int>(), 100) << "its tone was applied";
    std::filesystem::create_directories(at("deeper/materials"));
    std::filesystem::rename(at("denim.haptomaterial"), at("deeper/materials/denim.haptomaterial"));
    writeScene("materials/denim.haptomaterial", json::object(), "deeper/scene.json");
    const Finished run = this->run("render deeper/scene.json --stroke stroke.csv -o again.wav");
    EXPECT_EQ(run.exitCode, 0) << run.errors;
    EXPECT_EQ(read("again.wav"), read("felt.wav"));
}

TEST_F(MaterialCommandTest, AMaterialFileCanBeAKeyOfABlend) {
    writeScene({{"denim.haptomaterial", 0.5}, {"wood", 0.5}});
    EXPECT_GT(rendered().at("rms_mps2").get<double>(), 0.01);
}

TEST_F(MaterialCommandTest, TheNameOfAMaterialOnTheCommandLineCountsAsALabel) {
    writeMaterial("second.haptomaterial", [](json& material) { material["name"] = "canvas"; });
    writeScene("denim");
    (void)rendered("--material second.haptomaterial --material denim.haptomaterial");
    const std::string byName = read("felt.wav");
    writeScene("denim.haptomaterial");
    (void)rendered();
    EXPECT_EQ(read("felt.wav"), byName) << "the same material by each name";
    const Finished contact = run("contact scene.json --stroke stroke.csv --material denim.haptomaterial");
    EXPECT_EQ(contact.exitCode, 0) << contact.errors;
}

TEST_F(MaterialCommandTest, TheStiffnessOfAMaterialIsThatOfItsSurface) {
    const auto forces = [this] { return run("contact scene.json --stroke stroke.csv").output; };
    writeScene("denim.haptomaterial");
    const std::string soft = forces();
    writeMaterial("denim.haptomaterial", [](json& material) { material["stiffness_newtons_per_metre"] = 3000.0; });
    EXPECT_NE(forces(), soft);
}

TEST_F(MaterialCommandTest, AnUnusableMaterialIsRefusedWithSceneSurfaceFileAndKey) {
    writeScene("corduroi.haptomaterial");
    expectRefused("", "scene.json: surface 'floor': corduroi.haptomaterial: there is no such file");
    writeMaterial("broken.haptomaterial", [](json& material) { material["tone"]["gains_db"].erase(0); });
    writeScene("broken.haptomaterial");
    expectRefused("", "broken.haptomaterial: material key \"tone.gains_db\": expected one row for each of the 2");
    writeMaterial("foreign.haptomaterial", [](json& material) { material["space"] = "00000000"; });
    writeScene("foreign.haptomaterial");
    expectRefused("", "foreign.haptomaterial: material \"denim\" was learnt for the space 00000000");
    writeScene("denym");
    expectRefused("--material denim.haptomaterial", "did you mean 'denim'");
    writeMaterial("wood.haptomaterial", [](json& material) { material["name"] = "wood"; });
    writeScene("wood");
    expectRefused("--material wood.haptomaterial",
                  "its name is \"wood\", which is already that of a label of the model");
    expectRefused("--material nowhere.haptomaterial", "nowhere.haptomaterial: there is no such file");
}

TEST_F(MaterialCommandTest, SpatialScaleAndToneOfASurfaceAreRenderedAndTheirRangesAreNamed) {
    writeScene("corduroy");
    (void)rendered();
    const std::string plain = read("felt.wav");
    writeScene("corduroy", {{"spatial_scale", 1.0}, {"tone_db_per_octave", 0.0}});
    (void)rendered();
    EXPECT_EQ(read("felt.wav"), plain) << "a scale of 1 and no tilt change nothing";
    writeScene("corduroy", {{"spatial_scale", 2.0}});
    (void)rendered();
    EXPECT_NE(read("felt.wav"), plain);
    writeScene("corduroy", {{"tone_db_per_octave", 3.0}});
    EXPECT_TRUE(rendered().at("effects").contains("tone"));
    writeScene("corduroy", {{"spatial_scale", 5.0}});
    expectRefused("", "surfaces[0].spatial_scale: expected a factor from 0.25 to 4, found 5.0");
    writeScene("corduroy", {{"tone_db_per_octave", "bright"}});
    expectRefused("", "surfaces[0].tone_db_per_octave: expected dB from -12 to 12");
}

TEST_F(MaterialCommandTest, InspectShowsAMaterialFile) {
    const Finished shown = run("inspect denim.haptomaterial");
    EXPECT_EQ(shown.exitCode, 0) << shown.errors;
    EXPECT_THAT(shown.output, AllOf(HasSubstr("denim"), HasSubstr(space_), HasSubstr("10.5 s"),
                                    HasSubstr("its own, at 3 speeds from 0.05 to 0.2 m/s, 3 dB added"),
                                    HasSubstr("2 frequencies at 2 speeds"), HasSubstr("unknown")));
    const Finished asJson = run("inspect denim.haptomaterial --json");
    EXPECT_EQ(json::parse(asJson.output).at("material").at("name"), "denim");
    write("broken.haptomaterial", "{}");
    const Finished broken = run("inspect broken.haptomaterial");
    EXPECT_EQ(broken.exitCode, 3);
    EXPECT_THAT(broken.errors, HasSubstr("broken.haptomaterial: material: expected a member \"format\""));
    EXPECT_THAT(run("inspect '" HAPTOFLOW_TEST_DEFAULT_MODEL "'").output, HasSubstr(space_));
}

}  // namespace
}  // namespace haptoflow::cli
