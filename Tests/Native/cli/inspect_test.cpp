#include "command_line.hpp"
#include "messages.hpp"
#include "option_values.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>
#include <tuple>

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

template <typename Action>
std::string refusalOf(Action action) {
    try {
        (void)action();
    } catch (const InputError& error) {
        return error.what();
    }
    ADD_FAILURE() << "no InputError was thrown";
    return {};
}

TEST(ModelLocationTest, TheEnvironmentNamesTheModel) {
    const Environment model("HAPTOFLOW_MODEL", HAPTOFLOW_TEST_GOLDEN_DIR "/model/tiny.haptoflow");
    EXPECT_EQ(findModel(""), HAPTOFLOW_TEST_GOLDEN_DIR "/model/tiny.haptoflow");
    EXPECT_EQ(readModel(findModel("")).header().name, "tiny");
}

TEST(ModelLocationTest, AMissingModelOfTheEnvironmentIsRefusedWithTheVariable) {
    const Environment model("HAPTOFLOW_MODEL", "/nowhere/a.haptoflow");
    const std::string refusal = refusalOf([] { return findModel(""); });
    EXPECT_THAT(refusal, HasSubstr("/nowhere/a.haptoflow"));
    EXPECT_THAT(refusal, HasSubstr("HAPTOFLOW_MODEL"));
}

TEST(ModelLocationTest, TheErrorForAMissingRuntimeNamesThePlacesAndTheRemedy) {
    // The test program is deeper in the build folder than the command line, so that none of the places exists.
    const Environment runtime("HAPTOFLOW_ONNXRUNTIME", std::nullopt);
    const std::string refusal = refusalOf([] { return findOnnxRuntime(); });
    EXPECT_THAT(refusal, HasSubstr("HAPTOFLOW_ONNXRUNTIME (not set)"));
    EXPECT_THAT(refusal, HasSubstr("node_modules/com.github.asus4.onnxruntime/Plugins"));
    EXPECT_THAT(refusal, HasSubstr("`npm ci`"));
    EXPECT_THAT(refusal, HasSubstr("`npm run build`"));
}

TEST(ModelLocationTest, ARuntimeThatIsNotALibraryIsAnInputError) {
    const Environment runtime("HAPTOFLOW_ONNXRUNTIME", HAPTOFLOW_TEST_GOLDEN_DIR "/model/tiny.haptoflow");
    EXPECT_THAT(refusalOf([] { return openRuntime(); }), HasSubstr("tiny.haptoflow: cannot be loaded"));
}

}  // namespace
}  // namespace haptoflow::cli
