#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

namespace haptoflow::cli::testing {

inline const std::string tinyModel = HAPTOFLOW_TEST_GOLDEN_DIR "/model/tiny.haptoflow";

struct Finished {
    int exitCode = -1;
    std::string output;
    std::string errors;
};

/// A command line that must fail: its words, its exit code and a part of its message.
struct Refusal {
    std::string words;
    int exitCode;
    std::string message;
};

/// Runs the command line with these arguments, quoted for a shell, and with the repository's ONNX Runtime and model;
/// `before` precedes it in the shell.
inline Finished runHaptoFlow(const std::string& words, const std::string& before = "") {
    const auto errors = std::filesystem::temp_directory_path() /
                        ("haptoflow_" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()) +
                         '_' + std::to_string(getpid()));
    const std::string command = before +
                                "HAPTOFLOW_ONNXRUNTIME='" HAPTOFLOW_TEST_ONNXRUNTIME
                                "' HAPTOFLOW_MODEL='" HAPTOFLOW_TEST_DEFAULT_MODEL "' '" HAPTOFLOW_TEST_CLI "' " +
                                words + " 2>'" + errors.string() + "'";
    FILE* pipe = popen(command.c_str(), "r");
    if (pipe == nullptr) {
        throw std::runtime_error("the program cannot be started: " HAPTOFLOW_TEST_CLI);
    }
    Finished run;
    std::array<char, 4096> part{};
    while (const std::size_t count = std::fread(part.data(), 1, part.size(), pipe)) {
        run.output.append(part.data(), count);
    }
    run.exitCode = WEXITSTATUS(pclose(pipe));
    std::ifstream stream(errors);
    run.errors.assign(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
    std::filesystem::remove(errors);
    return run;
}

/// A temporary folder with a scene (a wooden floor without stiffness), a stroke that slides over it for 0.3 s, and the
/// files of a test.
class CommandLineTest : public ::testing::Test {
protected:
    void SetUp() override {
        const ::testing::TestInfo& info = *::testing::UnitTest::GetInstance()->current_test_info();
        folder_ = std::filesystem::temp_directory_path() / ("haptoflow_" + std::string(info.test_suite_name()) + "_" +
                                                            std::string(info.name()) + '_' + std::to_string(getpid()));
        std::filesystem::remove_all(folder_);
        std::filesystem::create_directories(folder_);
        write("scene.json", R"({"surfaces": [{"name": "floor", "shape": {"plane": {}}, "material": "wood"}]})");
        write("stroke.csv", "t,x,y,z\n0,0,0.0005,0\n0.3,0.03,0.0005,0\n");
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    void write(const std::string& name, const std::string& text) const {
        std::ofstream(folder_ / name, std::ios::binary) << text;
    }
    [[nodiscard]] std::string read(const std::string& name) const {
        std::ifstream file(folder_ / name, std::ios::binary);
        return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    }
    [[nodiscard]] std::filesystem::path at(const std::string& name) const { return folder_ / name; }
    [[nodiscard]] bool exists(const std::string& name) const { return std::filesystem::exists(folder_ / name); }
    [[nodiscard]] std::size_t fileCount() const {
        const auto files = std::filesystem::directory_iterator(folder_);
        return static_cast<std::size_t>(std::distance(begin(files), end(files)));
    }

    /// Runs the command line in the folder.
    [[nodiscard]] Finished run(const std::string& words) const {
        return runHaptoFlow(words, "cd '" + folder_.string() + "' && ");
    }
    /// `render` of the scene and the stroke with more words.
    [[nodiscard]] Finished render(const std::string& words) const {
        return run("render scene.json --stroke stroke.csv " + words);
    }
    /// The report of a `render` to felt.wav that must succeed.
    [[nodiscard]] nlohmann::json rendered(const std::string& words = "") const {
        const Finished finished = render("-o felt.wav --report felt.json " + words);
        EXPECT_EQ(finished.exitCode, 0) << finished.errors;
        return finished.exitCode == 0 ? nlohmann::json::parse(read("felt.json")) : nlohmann::json::object();
    }
    /// Runs command lines that must fail, each behind the words `before`, without another file in the folder.
    void expectRefusals(const std::vector<Refusal>& refusals, const std::string& before = "") const {
        const std::size_t files = fileCount();
        for (const auto& [words, exitCode, message] : refusals) {
            const Finished finished = run(before + words);
            EXPECT_EQ(finished.exitCode, exitCode) << words << '\n' << finished.errors;
            EXPECT_THAT(finished.errors, ::testing::HasSubstr(message)) << words;
            EXPECT_EQ(fileCount(), files) << words;
        }
    }

private:
    std::filesystem::path folder_;
};

}  // namespace haptoflow::cli::testing
