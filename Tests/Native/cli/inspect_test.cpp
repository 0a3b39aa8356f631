#include "command_line.hpp"

#include <nlohmann/json.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <string>

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

std::string bytesOf(const std::string& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// A temporary file for one test.
class ScratchFile {
public:
    explicit ScratchFile(const std::string& content)
        : path_((std::filesystem::temp_directory_path() /
                 ("inspect_" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name())))
                    .string()) {
        std::ofstream(path_, std::ios::binary) << content;
    }
    ScratchFile(const ScratchFile&) = delete;
    ScratchFile& operator=(const ScratchFile&) = delete;
    ~ScratchFile() { std::remove(path_.c_str()); }

    [[nodiscard]] const std::string& path() const { return path_; }

private:
    std::string path_;
};

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

TEST(InspectTest, AMissingFileIsRefusedByName) {
    const Finished run = inspect("/nowhere/a.haptoflow");
    EXPECT_EQ(run.exitCode, 3);
    EXPECT_THAT(run.output, HasSubstr("/nowhere/a.haptoflow: there is no such file"));
}

TEST(InspectTest, ADamagedFileIsRefusedWithItsChecksum) {
    std::string content = bytesOf(tinyModel);
    ASSERT_GT(content.size(), 1000U);
    content[200] = static_cast<char>(content[200] ^ 4);
    const ScratchFile file(content);
    const Finished run = inspect(file.path() + " --json");
    EXPECT_EQ(run.exitCode, 3);
    EXPECT_THAT(run.output, HasSubstr(file.path()));
    EXPECT_THAT(run.output, HasSubstr("checksum at byte 24"));
}

TEST(InspectTest, AFileOfAnotherKindIsRefused) {
    const ScratchFile file("RIFF....WAVEfmt and so on, long enough to be looked at");
    const Finished run = inspect(file.path());
    EXPECT_EQ(run.exitCode, 3);
    EXPECT_THAT(run.output, HasSubstr("not a .haptoflow file"));
}

TEST(InspectTest, ACallWithoutAFileIsRefused) {
    EXPECT_EQ(inspect("").exitCode, 2);
}

}  // namespace
}  // namespace haptoflow::cli
