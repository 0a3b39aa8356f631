#pragma once

#include <gtest/gtest.h>

#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

namespace haptoflow::cli::testing {

inline const std::string tinyModel = HAPTOFLOW_TEST_GOLDEN_DIR "/model/tiny.haptoflow";

struct Finished {
    int exitCode = -1;
    std::string output;
    std::string errors;
};

/// Runs the command line with these words, quoted for a shell, and with the repository's ONNX Runtime.
inline Finished runHaptoFlow(const std::string& words) {
    const auto errors = std::filesystem::temp_directory_path() /
                        ("haptoflow_" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
    const std::string command = "HAPTOFLOW_ONNXRUNTIME='" HAPTOFLOW_TEST_ONNXRUNTIME "' '" HAPTOFLOW_TEST_CLI "' " +
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

}  // namespace haptoflow::cli::testing
