// One rule for every command: no output is a file that the command reads, nor another of its outputs, and an output
// appears whole or not at all.
#include "command_line.hpp"
#include "made_files.hpp"

#include "model/material_builder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <map>
#include <string>

namespace haptoflow::cli {
namespace {

namespace fs = std::filesystem;

using learning::testing::MadeRecording;
using testing::Finished;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* profile = R"({"format_version": 1, "name": "a", "approximate": false, "provenance": "made",
    "rated_level_mps2": null, "frequency_hz": [20, 1200], "magnitude_db": [0, 0], "resonances_hz": []})";

class OutputFilesTest : public testing::CommandLineTest {
protected:
    /// A recording with each kind of file beside it, a material, a profile and a scene that uses the material.
    void SetUp() override {
        testing::CommandLineTest::SetUp();
        write("tile.csv", testing::tableOf(MadeRecording({}, {}), "time_s,acceleration_mps2,a,b,c"));
        write("tile.json", R"({"label": "tile", "motion": "tile.motion.csv"})");
        write("recordings.json", R"({"licence": "CC0"})");
        std::string motion = "time_s,speed_mps,force_newtons\n";
        for (int i = 0; i <= 1100; ++i) {
            motion += std::to_string(0.01 * i) + "," + std::to_string(0.05 + 0.0001 * i) + ",0.7\n";
        }
        write("tile.motion.csv", motion);
        write("a.json", profile);
        fs::copy_file(HAPTOFLOW_TEST_DEFAULT_MODEL, at("model.haptoflow"));
        std::ifstream golden(HAPTOFLOW_TEST_GOLDEN_DIR "/material/expected.json");
        const std::string space = nlohmann::json::parse(golden).at("spaces").at("default").get<std::string>();
        write("m.haptomaterial", model::testing::validMaterial(space).dump());
        write("material-scene.json",
              R"({"surfaces": [{"name": "f", "shape": {"plane": {}}, "material": "m.haptomaterial"}]})");
    }

    /// The bytes of every file in the folder.
    [[nodiscard]] std::map<std::string, std::string> contents() const {
        std::map<std::string, std::string> files;
        for (const auto& each : fs::directory_iterator(at(""))) {
            if (each.is_regular_file()) {
                files[each.path().filename().string()] = read(each.path().filename().string());
            }
        }
        return files;
    }

    /// The command is refused as wrong usage with words that name both files and a remedy; no byte changes.
    void expectRefused(const std::string& words, const std::string& output, const std::string& input) const {
        const auto before = contents();
        const Finished finished = run(words);
        EXPECT_EQ(finished.exitCode, 2) << words << '\n' << finished.errors;
        EXPECT_THAT(finished.errors, HasSubstr(output + ": is the same file as " + input)) << words;
        EXPECT_THAT(finished.errors, HasSubstr("name another")) << words;
        EXPECT_TRUE(contents() == before) << words;
    }
};

TEST_F(OutputFilesTest, LearnLeavesEveryFileThatItReadsAsItIs) {
    const std::string learn = "learn tile.csv --model model.haptoflow --quiet -o new.haptomaterial --report ";
    expectRefused(learn + "tile.csv", "--report tile.csv", "the recording tile.csv");
    expectRefused(learn + "tile.json", "--report tile.json", "the recording's sidecar tile.json");
    expectRefused(learn + "recordings.json", "--report recordings.json", "the folder's defaults recordings.json");
    expectRefused(learn + "tile.motion.csv", "--report tile.motion.csv", "the motion file tile.motion.csv");
    expectRefused(learn + "model.haptoflow", "--report model.haptoflow", "the model model.haptoflow");
    expectRefused(learn + "./new.haptomaterial", "--report ./new.haptomaterial", "--output new.haptomaterial");
    expectRefused("learn tile.csv --model model.haptoflow -o tile.json", "--output tile.json",
                  "the recording's sidecar");
}

TEST_F(OutputFilesTest, ASidecarThatIsNotThereYetIsNoPlaceForAReport) {
    fs::rename(at("tile.json"), at("other.json"));
    const std::string words = " --speed-mps 0.1 --force-newtons 1 --model model.haptoflow -o new.haptomaterial";
    expectRefused("learn tile.csv --report tile.json" + words, "--report tile.json", "the recording's sidecar");
    fs::remove(at("recordings.json"));
    expectRefused("learn tile.csv --report ./recordings.json" + words, "--report ./recordings.json",
                  "the folder's defaults");
}

TEST_F(OutputFilesTest, RenderLeavesEveryFileThatItReadsAsItIs) {
    const std::string render = "render material-scene.json --stroke stroke.csv --model model.haptoflow --quiet ";
    expectRefused(render + "--actuator a.json -o a.json", "-o a.json", "the actuator profile a.json");
    expectRefused(render + "-o w.wav --actuator a.json --report a.json", "--report a.json", "the actuator profile");
    expectRefused(render + "-o w.wav --report m.haptomaterial", "--report m.haptomaterial", "the material");
    fs::copy_file(at("m.haptomaterial"), at("given.json"));
    expectRefused("render scene.json --stroke stroke.csv --material given.json -o given.json", "-o given.json",
                  "the material given.json");
    expectRefused("render scene.json --stroke stroke.csv --material given.json -o w.wav --report given.json",
                  "--report given.json", "the material given.json");
    expectRefused(render + "-o w.wav --waveform w.wav", "--waveform w.wav", "-o w.wav");
    expectRefused(render + "-o w.wav -o r.json --report r.json", "r.json", "");
}

TEST_F(OutputFilesTest, ContactAndActuatorAndBenchLeaveEveryFileThatTheyReadAsItIs) {
    const std::string contact = "contact material-scene.json --stroke stroke.csv --model model.haptoflow -o ";
    expectRefused(contact + "m.haptomaterial", "-o m.haptomaterial", "the material");
    expectRefused(contact + "model.haptoflow", "-o model.haptoflow", "the model model.haptoflow");
    expectRefused(contact + "stroke.csv", "-o stroke.csv", "the stroke stroke.csv");
    expectRefused("actuator show a.json --plot a.json", "--plot a.json", "the actuator profile a.json");
    expectRefused("actuator show a.json --labels --model model.haptoflow --plot model.haptoflow",
                  "--plot model.haptoflow", "the model");
    ASSERT_EQ(run("actuator sweep -o sweep.wav --seconds 1").exitCode, 0);
    expectRefused("actuator identify sweep.wav --sweep sweep.wav -o sweep.wav", "-o sweep.wav", "--sweep sweep.wav");
    expectRefused("actuator identify sweep.wav --sweep sweep.wav -o new.json --plot ./new.json", "--plot ./new.json",
                  "-o new.json");
    expectRefused("bench --quick --only callback --quiet --model model.haptoflow -o model.haptoflow",
                  "-o model.haptoflow", "the model");
}

TEST_F(OutputFilesTest, AnotherSpellingOfAFileIsTheSameFile) {
    fs::create_directory(at("folder"));
    fs::create_symlink(at("tile.json"), at("link.json"));
    fs::create_hard_link(at("tile.json"), at("hard.json"));
    fs::create_directory_symlink(at(""), at("folder/here"));
    const std::string learn = "learn tile.csv --model model.haptoflow --quiet -o new.haptomaterial --report ";
    for (const std::string name :
         {"./tile.json", "folder/../tile.json", "link.json", "hard.json", "folder/here/tile.json"}) {
        expectRefused(learn + name, "--report " + name, "the recording's sidecar");
    }
    expectRefused(learn + at("tile.json").string(), "--report " + at("tile.json").string(), "the recording's sidecar");
    expectRefused("learn tile.csv --model model.haptoflow -o new.haptomaterial --report folder/here/new.haptomaterial",
                  "--report folder/here/new.haptomaterial", "--output new.haptomaterial");
}

TEST_F(OutputFilesTest, StandardInputAndOutputThatAreFilesAreFilesLikeOthers) {
    const auto before = contents();
    const Finished in = run("contact /dev/stdin --stroke stroke.csv -o scene.json < scene.json");
    EXPECT_EQ(in.exitCode, 2) << in.errors;
    const Finished out = run("contact scene.json --stroke stroke.csv -o /dev/stdout >> scene.json");
    EXPECT_EQ(out.exitCode, 2) << out.errors;
    EXPECT_TRUE(contents() == before);
    const Finished pipe = run("contact scene.json --stroke stroke.csv -o /dev/stdout");
    EXPECT_EQ(pipe.exitCode, 0) << pipe.errors;
    EXPECT_THAT(pipe.output, HasSubstr("touch_counter"));
}

TEST_F(OutputFilesTest, ADashIsStandardOutputAndMessagesGoElsewhere) {
    const std::size_t before = contents().size();
    ASSERT_EQ(run("render scene.json --stroke stroke.csv -o sound.wav --quiet").exitCode, 0);
    const Finished rendered = run("render scene.json --stroke stroke.csv -o - --quiet");
    EXPECT_EQ(rendered.exitCode, 0) << rendered.errors;
    EXPECT_TRUE(rendered.output == read("sound.wav")) << rendered.output.size();
    const Finished contact = run("contact scene.json --stroke stroke.csv -o -");
    EXPECT_EQ(contact.output, run("contact scene.json --stroke stroke.csv").output);
    const Finished learnt = run("learn tile.csv --model '" + std::string(testing::tinyModel) + "' --quiet -o -");
    EXPECT_EQ(learnt.exitCode, 0) << learnt.errors;
    EXPECT_TRUE(nlohmann::json::accept(learnt.output)) << learnt.output.substr(0, 200);
    EXPECT_THAT(learnt.errors, HasSubstr("Learnt tile from "));
    const Finished both = run("render scene.json --stroke stroke.csv -o - --report - --quiet");
    EXPECT_EQ(both.exitCode, 2) << both.errors;
    EXPECT_THAT(both.errors, HasSubstr("--report -: is the same file as -o -"));
    EXPECT_EQ(both.output, "");
    EXPECT_EQ(contents().size(), before + 1) << "a file named - was written";
}

TEST_F(OutputFilesTest, AFullDiskLeavesTheOldFileAndNothingElse) {
    write("felt.wav", "old");
    write("states.csv", "old");
    const auto before = contents();
    // A limit on the size of files fails like a full disk; the signal that comes with it is ignored.
    const std::string limited = "cd '" + at("").string() + "' && trap '' XFSZ && ulimit -f 1 && ";
    const Finished rendered =
        testing::runHaptoFlow("render scene.json --stroke stroke.csv -o felt.wav --quiet", limited);
    EXPECT_EQ(rendered.exitCode, 3);
    EXPECT_THAT(rendered.errors, HasSubstr("felt.wav: could not be written to its end"));
    const Finished contact = testing::runHaptoFlow("contact scene.json --stroke stroke.csv -o states.csv", limited);
    EXPECT_EQ(contact.exitCode, 3);
    EXPECT_THAT(contact.errors, HasSubstr("states.csv: could not be written to its end"));
    EXPECT_TRUE(contents() == before);
    const Finished full = run("contact scene.json --stroke stroke.csv -o /dev/full");
    EXPECT_EQ(full.exitCode, 3);
    EXPECT_THAT(full.errors, HasSubstr("/dev/full: could not be written to its end"));
}

}  // namespace
}  // namespace haptoflow::cli
