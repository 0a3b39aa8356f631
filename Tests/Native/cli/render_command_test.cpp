#include "command_line.hpp"
#include "messages.hpp"
#include "model/model_builder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace haptoflow::cli {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using testing::Finished;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::tinyModel;

class RenderCommandTest : public testing::CommandLineTest {
protected:
    /// Options of `render` that are wrong usage, with this text in the message.
    void expectUsage(const std::vector<std::pair<std::string, std::string>>& rows) const {
        for (const auto& [words, message] : rows) {
            expectRefusals({{words, 2, message}}, "render scene.json --stroke stroke.csv -o felt.wav ");
        }
    }
};

TEST_F(RenderCommandTest, AModelWhoseGraphsCannotBeLoadedIsAnInputErrorWithTierAndGraph) {
    // The checksums are correct, but ONNX Runtime could run none of the graphs.
    const std::vector<std::byte> bytes = model::testing::ModelBuilder{}.build();
    write("broken.haptoflow", {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    write("oak.json", R"({"surfaces": [{"name": "floor", "shape": {"plane": {}}, "material": "oak"}]})");
    const Finished rendered = run("render oak.json --stroke stroke.csv -o felt.wav --model broken.haptoflow");
    EXPECT_EQ(rendered.exitCode, 3) << rendered.errors;
    EXPECT_THAT(rendered.errors, AllOf(HasSubstr("tier"), Not(HasSubstr("internal"))));
    EXPECT_FALSE(exists("felt.wav"));
}

TEST_F(RenderCommandTest, TiersWithASkeletonRenderAndTakeNoSolver) {
    const std::string model = " --model '" HAPTOFLOW_TEST_GOLDEN_DIR "/model/skeleton.haptoflow'";
    write("ruled.json", R"({"surfaces": [{"name": "floor", "shape": {"plane": {}}, "material": "ruled"}]})");
    for (const std::string quality : {"sketch", "standard"}) {
        const std::string words =
            "render ruled.json --stroke stroke.csv -o felt.wav --report felt.json --quality " + quality + model;
        const Finished finished = run(words);
        EXPECT_EQ(finished.exitCode, 0) << finished.errors;
        EXPECT_GT(nlohmann::json::parse(read("felt.json")).at("rms_mps2").get<double>(), 0.0) << quality;
        expectRefusals({{words + " --solver euler --steps 2", 2, "evaluated once"}});
    }
}

TEST_F(RenderCommandTest, AVariationMakesSurfacesOfOneLabelDifferByTheirSeed) {
    const auto rendered = [this](const std::string& seed, const std::string& variation) {
        write("ruled.json", R"({"surfaces": [{"name": "floor", "shape": {"plane": {}}, "material": "ruled", "seed": )" +
                                seed + R"(, "variation": )" + variation + "}]}");
        const Finished done =
            run("render ruled.json --stroke stroke.csv -o felt.wav --report felt.json --quality sketch "
                "--model '" HAPTOFLOW_TEST_GOLDEN_DIR "/model/skeleton.haptoflow'");
        EXPECT_EQ(done.exitCode, 0) << done.errors;
        return nlohmann::json::parse(read("felt.json")).at("rms_mps2").get<double>();
    };
    const double mean = rendered("1", "0");
    EXPECT_EQ(rendered("1", "0.0"), mean);
    const double first = rendered("1", "1");
    EXPECT_EQ(rendered("1", "1"), first);
    EXPECT_NE(first, mean);
    EXPECT_NE(rendered("2", "1"), first);
}

TEST_F(RenderCommandTest, ALinkIsFollowedAndKept) {
    write("target.wav", "old");
    fs::create_symlink("target.wav", at("link.wav"));
    fs::create_symlink("to come.wav", at("dangling.wav"));
    ASSERT_EQ(render("-o link.wav").exitCode, 0);
    ASSERT_EQ(render("-o dangling.wav").exitCode, 0);
    EXPECT_TRUE(fs::is_symlink(at("link.wav")));
    EXPECT_TRUE(fs::is_symlink(at("dangling.wav")));
    EXPECT_EQ(read("target.wav").substr(0, 4), "RIFF");
    EXPECT_TRUE(read("to come.wav") == read("target.wav"));
}

TEST_F(RenderCommandTest, APipeIsWrittenAndStaysAPipe) {
    ASSERT_EQ(render("-o felt.wav").exitCode, 0);
    ASSERT_EQ(mkfifo(at("pipe").c_str(), 0600), 0);
    const Finished piped = testing::runHaptoFlow("render scene.json --stroke stroke.csv -o pipe; wait",
                                                 "cd '" + at("").string() + "' && { cat pipe >read.wav & } && ");
    EXPECT_TRUE(read("read.wav") == read("felt.wav")) << piped.errors;
    EXPECT_TRUE(fs::is_fifo(at("pipe")));
}

TEST_F(RenderCommandTest, AnOlderFileIsReplacedWithItsPermissions) {
    write("felt.wav", "old");
    fs::permissions(at("felt.wav"), fs::perms::owner_read | fs::perms::owner_write);
    ASSERT_EQ(render("-o felt.wav").exitCode, 0);
    EXPECT_EQ(read("felt.wav").substr(0, 4), "RIFF");
    EXPECT_EQ(fs::status(at("felt.wav")).permissions(), fs::perms::owner_read | fs::perms::owner_write);
}

TEST_F(RenderCommandTest, ARenderThatFailsLeavesNoFileAndTheOldOneUnchanged) {
    write("felt.wav", "old");
    write("felt.wav.part", "somebody else's");
    const std::size_t before = fileCount();
    EXPECT_EQ(render("-o felt.wav --report no/such/folder.json").exitCode, 3);
    EXPECT_EQ(render("-o felt.wav --waveform .").exitCode, 3);
    EXPECT_EQ(fileCount(), before);
    EXPECT_EQ(read("felt.wav"), "old");
    EXPECT_EQ(render("-o felt.wav").exitCode, 0);
    EXPECT_EQ(fileCount(), before);
    EXPECT_EQ(read("felt.wav.part"), "somebody else's");
}

/// A tip that hovers, with rows ten minutes apart.
std::string restingStroke(int steps) {
    std::string text = "t,x,y,z\n";
    for (int row = 0; row <= steps; ++row) {
        text += std::to_string(600 * row) + ",0,0.5,0\n";
    }
    return text;
}

TEST_F(RenderCommandTest, ARenderThatIsStoppedLeavesNoFile) {
    write("stroke.csv", restingStroke(15));
    const std::size_t before = fileCount();
    const Finished stopped = testing::runHaptoFlow(
        "render scene.json --stroke stroke.csv -o felt.wav --waveform raw.wav --rate 96000 & child=$!; "
        "while ! test -s felt.wav.part && kill -0 $child; do sleep 0.01; done; kill -TERM $child; wait $child",
        "cd '" + at("").string() + "'; ");
    constexpr int endedByTerm = 128 + 15;
    EXPECT_EQ(stopped.exitCode, endedByTerm) << stopped.errors;
    EXPECT_EQ(fileCount(), before);
}

TEST_F(RenderCommandTest, AFolderInPlaceOfAFileIsAnInputError) {
    fs::create_directory(at("folder"));
    for (const char* words :
         {"render folder --stroke stroke.csv -o felt.wav", "render scene.json --stroke folder -o felt.wav",
          "render scene.json --stroke stroke.csv -o felt.wav --model folder",
          "render scene.json --stroke stroke.csv -o folder", "contact folder --stroke stroke.csv",
          "contact scene.json --stroke folder", "contact scene.json --stroke stroke.csv -o folder", "inspect folder"}) {
        expectRefusals({{words, 3, "folder: is a folder; expected"}});
    }
}

TEST_F(RenderCommandTest, InvalidNumbersAndNumbersOutOfRangeAreUsageErrors) {
    for (const std::string option : {"--rate", "--full-scale", "--lead-ms"}) {
        for (const char* value : {"nan", "-nan", "NaN", "inf", "-1", "1e400", "0x10000", "12,5", "wood"}) {
            expectUsage({{option + "=" + value, option + ": expected a"}});
        }
    }
    for (const char* seed : {"-1", "18446744073709551616", "99999999999999999999999", "1e3", "0x10", "1.5", "+1"}) {
        expectUsage({{std::string("--seed=") + seed, "--seed: expected a whole number from 0 to"}});
    }
    expectUsage({{"--rate 44100.5", "--rate: expected a whole number from 8000 to 192000 Hz"},
                 {"--solver euler --steps 2.5", "--steps: expected a whole number from 1 to 16"}});
    EXPECT_EQ(run("contact scene.json --stroke stroke.csv --default-stiffness=nan").exitCode, 2);
}

TEST_F(RenderCommandTest, ASeedIsUsedExactly) {
    ASSERT_EQ(render("-o largest.wav --seed 18446744073709551615").exitCode, 0);
    ASSERT_EQ(render("-o ten.wav --seed 10").exitCode, 0);
    ASSERT_EQ(render("-o zero-ten.wav --seed 010").exitCode, 0);
    EXPECT_TRUE(read("zero-ten.wav") == read("ten.wav"));
    EXPECT_TRUE(read("largest.wav") != read("ten.wav"));
}

TEST_F(RenderCommandTest, ASoundFileOtherThanWavIsRefusedWithAValidName) {
    const std::string render = "render scene.json --stroke stroke.csv ";
    expectRefusals({{render + "-o felt.mp3", 2, "only WAV is written, not '.mp3'; did you mean felt.wav?"},
                    {render + "-o felt.wav --waveform raw.flac", 2, "did you mean raw.wav?"}});
    EXPECT_EQ(this->render("-o FELT.WAV").exitCode, 0);
    EXPECT_EQ(this->render("-o felt").exitCode, 0);
}

TEST_F(RenderCommandTest, AMisspeltCommandOptionOrQualityIsRefusedWithASuggestion) {
    expectRefusals({{"redner scene.json --stroke stroke.csv -o felt.wav", 2,
                     "there is no command 'redner'; did you mean 'render'?"},
                    {"xylophone", 2, "The commands are render, contact, inspect, actuator, learn, export-set, bench"}});
    EXPECT_THAT(run("xylophone").errors, Not(HasSubstr("did you mean")));
    expectUsage({{"--sede 4", "There is no option '--sede'; did you mean '--seed'?"},
                 {"--qualty=fine", "did you mean '--quality'?"},
                 {"--quality Standart", "did you mean 'standard'? This model has sketch, draft, standard"}});
}

TEST_F(RenderCommandTest, AnUnknownLabelIsRefusedWithTheNearestThreeAndTheListOfAll) {
    for (const auto& [written, meant] : {std::pair{"wod", "'wood'"}, {"cork", "'fur'"}}) {
        write("scene.json", std::string(R"({"surfaces": [{"name": "floor", "shape": {"plane": {}}, "material": ")") +
                                written + "\"}]}");
        for (const char* words :
             {"render scene.json --stroke stroke.csv -o felt.wav", "contact scene.json --stroke stroke.csv"}) {
            const Finished finished = run(words);
            EXPECT_EQ(finished.exitCode, 3);
            EXPECT_THAT(finished.errors,
                        AllOf(HasSubstr(std::string("'") + written + "', which the model does not know; did you mean "),
                              HasSubstr(meant), HasSubstr("default.haptoflow` lists all 20")));
        }
    }
    EXPECT_FALSE(exists("felt.wav"));
}

TEST_F(RenderCommandTest, SolverAndStepsAreThoseOfTheTierOrAskedForWhereItIsSolved) {
    struct Solved {
        std::string words;
        nlohmann::json tier;
        nlohmann::json solver;
        nlohmann::json steps;
    };
    const auto expectSolved = [this](const std::vector<Solved>& rows) {
        for (const auto& [words, tier, solver, steps] : rows) {
            const nlohmann::json report = rendered(words);
            EXPECT_EQ(nlohmann::json({report["tier"], report["solver"], report["steps"]}),
                      nlohmann::json({tier, solver, steps}))
                << words;
        }
    };
    expectUsage({{"--solver midpoint --steps 4",
                  "--solver and --steps have no effect on the tier 'standard', which is evaluated once"},
                 {"--quality draft --solver euler --steps 1", "no effect on the tier 'draft'"}});
    expectSolved({{"", "standard", nullptr, nullptr}});
    write("scene.json", R"({"surfaces": [{"name": "floor", "shape": {"plane": {}}, "material": "plain"}]})");
    const std::string tiny = "--model '" + tinyModel + "' ";
    expectUsage({{tiny + "--quality draft --solver midpoint --steps 3",
                  "always stepped by euler: did you mean --solver euler?"}});
    expectSolved({{tiny, "standard", "midpoint", 2},
                  {tiny + "--solver heun --steps 3", "standard", "heun", 3},
                  {tiny + "--quality draft --solver euler --steps 3", "draft", "euler", 3}});
}

TEST_F(RenderCommandTest, TouchesWithoutASoundAreCountedInANote) {
    struct Stroke {
        std::string rows;
        std::string updateRate;
        std::string note;
        std::string counts;
    };
    const std::vector<Stroke> strokes{
        {"0,0,0.5,0\n0.3,0.03,0.5,0\n", "90",
         "note: stroke.csv never touches a surface of scene.json: the output is silent", "[0,0,0]"},
        {"0,0,0.01,0\n0.1,0,0.0005,0\n0.2,0,0.0005,0\n0.3,0,0.01,0\n0.4,0,0.0005,0\n0.5,0,0.0005,0\n"
         "0.6,0,0.01,0\n0.7,0,0.0005,0\n1.0,0.05,0.0005,0\n1.1,0.05,0.01,0\n",
         "90", "2 of 3 touches make no sound", "[3,2,0]"},
        {"0,0,0.01,0\n0.14,0,0.01,0\n0.15,0.001,0.0005,0\n0.16,0.002,0.01,0\n0.5,0.002,0.01,0\n", "10",
         "1 of 1 touches begin and end between two frames", "[0,0,1]"}};
    for (const auto& [rows, updateRate, note, counts] : strokes) {
        write("scene.json", R"({"surfaces": [{"name": "floor", "shape": {"plane": {}}, "material": "wood"}], )"
                            R"("update_rate": )" +
                                updateRate + "}");
        write("stroke.csv", "t,x,y,z\n" + rows);
        const Finished finished = render("-o felt.wav --report felt.json");
        EXPECT_EQ(finished.exitCode, 0);
        EXPECT_THAT(finished.errors, HasSubstr(note));
        const auto report = nlohmann::json::parse(read("felt.json"));
        EXPECT_EQ(nlohmann::json({report["touches"], report["silent_touches"], report["missed_touches"]}).dump(),
                  counts)
            << note;
    }
}

TEST_F(RenderCommandTest, AStrokeTooLongForAWaveFileIsRefusedBeforeRendering) {
    write("scene.json",
          R"({"surfaces": [{"name": "floor", "shape": {"plane": {}}, "material": "wood"}], "update_rate": 1})");
    write("stroke.csv", restingStroke(28));
    expectRefusals({{"render scene.json --stroke stroke.csv -o felt.wav --rate 192000", 3,
                     "stroke.csv: lasts 16800 s; a WAV file at this --rate has room for 5592 s"}});
}

/// Peak memory in KiB of a render in its own process.
long peakKibibytes(const fs::path& folder, const std::vector<std::string>& words) {
    const pid_t child = fork();
    if (child == 0) {
        setenv("HAPTOFLOW_ONNXRUNTIME", HAPTOFLOW_TEST_ONNXRUNTIME, 1);
        setenv("HAPTOFLOW_MODEL", HAPTOFLOW_TEST_DEFAULT_MODEL, 1);
        std::vector<char*> arguments{const_cast<char*>(HAPTOFLOW_TEST_CLI)};
        for (const std::string& word : words) {
            arguments.push_back(const_cast<char*>(word.c_str()));
        }
        arguments.push_back(nullptr);
        if (chdir(folder.c_str()) == 0) {
            execv(HAPTOFLOW_TEST_CLI, arguments.data());
        }
        _exit(127);
    }
    int status = 0;
    rusage usage{};
    EXPECT_EQ(wait4(child, &status, 0, &usage), child);
    EXPECT_EQ(WEXITSTATUS(status), 0);
    return usage.ru_maxrss;
}

TEST_F(RenderCommandTest, MemoryDoesNotGrowWithTheLengthOfTheRender) {
    const auto peakOf = [this](int seconds) {
        std::string stroke = "t,x,y,z\n";
        for (int second = 0; second <= seconds; ++second) {
            stroke += std::to_string(second) + "," + (second % 2 == 0 ? "0" : "0.1") + ",0.0005,0\n";
        }
        write("stroke.csv", stroke);
        return peakKibibytes(at(""), {"render", "scene.json", "--stroke", "stroke.csv", "-o", "felt.wav", "--waveform",
                                      "raw.wav", "--quality", "draft", "--rate", "192000", "--quiet"});
    };
    const long shortPeak = peakOf(2);
    const long longPeak = peakOf(90);
    // 88 s more are 64 MiB of output.
    EXPECT_LT(longPeak - shortPeak, 8 * 1024) << shortPeak << " KiB for 2 s, " << longPeak << " KiB for 90 s";
    EXPECT_GT(fs::file_size(at("felt.wav")), 64U << 20U);
}

TEST_F(RenderCommandTest, TheReportAgreesWithTheWaveFile) {
    const nlohmann::json report = rendered("--rate 44100");
    const std::string wav = read("felt.wav");
    ASSERT_GT(wav.size(), 58U);
    const std::size_t data = wav.find("data");
    ASSERT_NE(data, std::string::npos);
    std::uint32_t bytes = 0;
    std::memcpy(&bytes, wav.data() + data + 4, sizeof bytes);
    EXPECT_EQ(data + 8 + bytes, wav.size());
    EXPECT_NEAR(report["seconds"].get<double>(), static_cast<double>(bytes) / 4.0 / 44100.0, 1e-9);
    float peak = 0.0F;
    for (std::size_t at = data + 8; at + 4 <= wav.size(); at += 4) {
        float sample = 0.0F;
        std::memcpy(&sample, wav.data() + at, sizeof sample);
        peak = std::max(peak, std::abs(sample));
    }
    EXPECT_FLOAT_EQ(report["peak"].get<float>(), peak);
    EXPECT_GT(peak, 0.0F);
    EXPECT_EQ(report["touches"], 1);
    EXPECT_EQ(report["silent_touches"], 0);
}

TEST(ProgressTest, WithoutATerminalALineIsPrintedEveryTenSeconds) {
    double nowSeconds = 100.0;
    std::vector<std::string> lines;
    const ProgressBar bar = progressLines(
        "render", [&nowSeconds] { return nowSeconds; }, [&lines](const std::string& line) { lines.push_back(line); });
    for (int second = 0; second <= 45; ++second) {
        nowSeconds = 100.0 + second;
        bar(second / 50.0, {});
    }
    EXPECT_THAT(lines, ::testing::ElementsAre("render: 20 %", "render: 40 %", "render: 60 %", "render: 80 %"));
}

}  // namespace
}  // namespace haptoflow::cli
