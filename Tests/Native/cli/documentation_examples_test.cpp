// Runs every command line of `haptoflow` in the documentation, with the files of its page.
#include "command_line.hpp"
#include "made_files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace haptoflow::cli {
namespace {

namespace fs = std::filesystem;

const fs::path repository = HAPTOFLOW_TEST_REPOSITORY_DIR;

std::string textOf(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// The code blocks of this language.
std::vector<std::string> blocksOf(const std::string& page, const std::string& language) {
    std::vector<std::string> blocks;
    const std::string fence = "\n```";
    for (std::size_t at = page.find(fence); at != std::string::npos;) {
        const std::size_t begin = page.find('\n', at + 1) + 1;
        const std::size_t end = page.find(fence, begin - 1);
        if (end == std::string::npos) {
            break;
        }
        if (page.substr(at + fence.size(), begin - 1 - at - fence.size()) == language) {
            blocks.push_back(page.substr(begin, end + 1 - begin));
        }
        at = page.find(fence, page.find('\n', end + 1));
    }
    return blocks;
}

const std::regex example(
    R"((^|\n|`)((?:\S*/)?haptoflow (?:render|contact|inspect|actuator|bench|learn)(?: [^`\n#]+)))");

/// The command lines of a text: in blocks, and between backquotes if they have arguments.
std::vector<std::string> examplesOf(const std::string& text) {
    std::vector<std::string> examples;
    for (auto found = std::sregex_iterator(text.begin(), text.end(), example); found != std::sregex_iterator();
         ++found) {
        examples.push_back((*found)[2].str());
    }
    return examples;
}

std::vector<fs::path> documentationPages() {
    std::vector<fs::path> pages{repository / "README.md", repository / "Training/results/README.md"};
    for (const char* folder : {"Documentation~", "Samples~"}) {
        for (const auto& entry : fs::recursive_directory_iterator(repository / folder)) {
            if (entry.path().extension() == ".md") {
                pages.push_back(entry.path());
            }
        }
    }
    return pages;
}

class DocumentationExamplesTest : public testing::CommandLineTest {
protected:
    void SetUp() override {
        CommandLineTest::SetUp();
        for (const char* name : {"Samples~", "Packages", "Tests"}) {
            fs::create_directory_symlink(repository / name, at(name));
        }
        fs::create_directories(at("build/native"));
        fs::create_symlink(HAPTOFLOW_TEST_CLI, at("build/native/haptoflow"));
        // The first model and scene are copied by commands of pages; the training tools make the other models.
        for (const char* model : {"default.haptoflow", "cluster.haptoflow", "paper.haptoflow"}) {
            fs::copy_file(HAPTOFLOW_TEST_DEFAULT_MODEL, at(model));
        }
        fs::copy_file(repository / "Samples~/HeadlessScenes/tracing.scene.json", at("desk.scene.json"));
        fs::copy_file(repository / "Samples~/HeadlessScenes/tracing.stroke.csv", at("desk.stroke.csv"));
        // Actuator profiles: from the sweep that a page writes, recorded over a wire.
        ASSERT_EQ(run("actuator sweep -o sweep.wav").exitCode, 0);
        fs::copy_file(at("sweep.wav"), at("recording.wav"));
        fs::copy_file(repository / "NativePlugin/profiles/voice-coil.json", at("pen.json"));
        write("click.haptic", R"({"version":{"major":1,"minor":0,"patch":0},"signals":{"continuous":{"envelopes":{
            "amplitude":[{"time":0,"amplitude":0.5},{"time":0.02,"amplitude":0}]}}}})");
    }

    /// Creates the files that a page shows or describes, with the names that its examples use.
    void makeFilesOf(const fs::path& page, const std::string& text) const {
        const std::vector<std::string> scenes = blocksOf(text, "json");
        const std::vector<std::string> strokes = blocksOf(text, "csv");
        if (!scenes.empty() && !strokes.empty()) {
            write("scene.json", scenes.front());
            write("stroke.csv", strokes.front());
        }
        for (const auto& entry : fs::directory_iterator(page.parent_path())) {
            if (entry.path().string().ends_with(".scene.json") || entry.path().string().ends_with(".stroke.csv")) {
                fs::copy_file(entry.path(), at(entry.path().filename().string()), fs::copy_options::overwrite_existing);
            }
        }
        if (page.filename() == "own-materials.md") {
            makeRecordings();
        }
    }

    /// Creates the recordings of the page on own materials, and a scene with the material learnt from the first.
    void makeRecordings() const {
        const learning::testing::MadeRecording made({}, {.seconds = 10.5});
        write("denim.csv", testing::tableOf(made));
        write("tile.csv", testing::tableOf(made));
        testing::writeWav(at("doormat.wav"), made, 100.0F);
        write("denim-floor.json", R"({"surfaces": [{"name": "floor", "shape": {"plane": {}}, "material": "denim"}]})");
    }

    void expectToRun(std::string command, const std::string& place) const {
        command = std::regex_replace(command, std::regex("^\\S*haptoflow "), "");
        command = std::regex_replace(command, std::regex(" MODEL\\b"), " default.haptoflow");
        command = std::regex_replace(command, std::regex(" PROFILE\\b"), " voice-coil");
        if (command.starts_with("bench") && command.find("--help") == std::string::npos) {
            // Other tests check the measurements; this one checks that the options are valid.
            command += " --events 1 --quiet --quick";
            command += command.find("--only") == std::string::npos ? " --only callback" : "";
        }
        const bool learns = command.starts_with("learn") && command.find("--help") == std::string::npos;
        if (learns) {
            // Other tests check the quality of a whole fit. Notes about a recording are expected here.
            command += " --seconds-limit 1.5 --quiet";
        }
        const testing::Finished finished = run(command);
        EXPECT_EQ(finished.exitCode, 0) << place << ": haptoflow " << command << '\n' << finished.errors;
        if (!learns) {
            EXPECT_THAT(finished.errors, ::testing::Not(::testing::HasSubstr("note:"))) << place << ": " << command;
        }
    }
};

TEST_F(DocumentationExamplesTest, EveryCommandLineOfEveryPageRuns) {
    std::size_t examples = 0;
    for (const fs::path& page : documentationPages()) {
        const std::string text = textOf(page);
        ASSERT_FALSE(text.empty()) << page;
        makeFilesOf(page, text);
        for (const std::string& command : examplesOf(text)) {
            ++examples;
            expectToRun(command, page.filename().string());
        }
    }
    // Scenes and strokes (2), getting started (4), headless scenes (2), stylus tracing, inspect twice, bench --help.
    // Materials of one's own: learn twice, render, inspect.
    EXPECT_GE(examples, 16U);
}

TEST_F(DocumentationExamplesTest, EveryExampleOfTheHelpRuns) {
    makeRecordings();
    makeFilesOf(repository / "Documentation~/scene-and-stroke.md",
                textOf(repository / "Documentation~/scene-and-stroke.md"));
    // A command's own help and that of the whole program have lines in common.
    std::set<std::string> examples;
    for (const char* command : {"learn ", "", "render ", "contact ", "inspect ", "actuator ", "actuator sweep ",
                                "actuator identify ", "actuator show ", "bench "}) {
        const std::string help = run(std::string(command) + "--help").output;
        for (const std::string& line : examplesOf(std::regex_replace(help, std::regex("\n +"), "\n"))) {
            if (examples.insert(line).second) {
                expectToRun(line + (line.find(" learn ") == std::string::npos ? "" : " --model " + testing::tinyModel),
                            std::string("haptoflow ") + command + "--help");
            }
        }
    }
    EXPECT_GE(examples.size(), 10U);
}

}  // namespace
}  // namespace haptoflow::cli
