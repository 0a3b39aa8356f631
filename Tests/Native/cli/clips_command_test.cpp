#include "clips/clip_formats.hpp"
#include "command_line.hpp"
#include "output_file.hpp"
#include "render_output.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

namespace haptoflow::cli {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

using testing::Finished;

class ClipsCommandTest : public testing::CommandLineTest {
protected:
    void SetUp() override {
        CommandLineTest::SetUp();
        // A landing, then a slide.
        write("stroke.csv", "t,x,y,z\n0,0,0.03,0\n0.1,0,0.0005,0\n0.6,0.05,0.0005,0\n");
    }
};

TEST_F(ClipsCommandTest, ARenderIsWrittenInEveryFormatAndReadAgain) {
    const Finished rendered = render(
        "-o felt.wav -o felt.haptic -o felt.ahap -o felt.hjif -o felt.csv -o felt.json --report felt.report.json "
        "--effects texture,impact --seed 3");
    ASSERT_EQ(rendered.exitCode, 0) << rendered.errors;
    const auto report = nlohmann::json::parse(read("felt.report.json"));
    ASSERT_EQ(report["clips"].size(), 3U);
    for (const auto& clip : report["clips"]) {
        EXPECT_GE(clip["transients"].get<int>(), 1) << clip;
        EXPECT_LT(clip["amplitude_error_db"].get<double>(), 0.56);
    }
    for (const std::string ending : {"haptic", "ahap", "hjif"}) {
        const clips::ReadClip read = clips::readClip(this->read("felt." + ending));
        EXPECT_NEAR(read.clip.durationSeconds, report["seconds"].get<double>(), 0.01) << ending;
        EXPECT_THAT(read.clip.origin.title + read.clip.origin.description,
                    AllOf(HasSubstr("wood"), HasSubstr("stroke.csv over scene.json"), HasSubstr("seed 3")));
        // The landing comes before the slide.
        ASSERT_FALSE(read.clip.transients.empty());
        EXPECT_NEAR(read.clip.transients.front().seconds, 0.11, 0.03);
        EXPECT_LT(clips::valueAt(read.clip.amplitude, 0.05, 1.0), 0.01);
        EXPECT_GT(clips::valueAt(read.clip.amplitude, 0.4, 0.0), 0.05);
    }
    EXPECT_THAT(read("felt.csv"), StartsWith("seconds,amplitude_mps2,frequency_hz,"));
    EXPECT_GT(std::ranges::count(read("felt.csv"), '\n'), 120);
}

TEST_F(ClipsCommandTest, EqualSeedsGiveEqualClips) {
    for (const std::string ending : {"haptic", "ahap"}) {
        ASSERT_EQ(render("-o one." + ending).exitCode, 0);
        ASSERT_EQ(render("-o other." + ending).exitCode, 0);
        EXPECT_EQ(read("one." + ending), read("other." + ending));
        ASSERT_EQ(render("--seed 2 -o other." + ending).exitCode, 0);
        EXPECT_NE(read("one." + ending), read("other." + ending));
    }
}

TEST_F(ClipsCommandTest, AClipIsShownAsTextAsJsonAndAsAPicture) {
    ASSERT_EQ(render("-o felt.ahap --effects texture,impact").exitCode, 0);
    const Finished shown = run("inspect felt.ahap --picture felt.svg");
    ASSERT_EQ(shown.exitCode, 0) << shown.errors;
    EXPECT_THAT(shown.output,
                AllOf(HasSubstr("▁"), HasSubstr("0.700 s"), HasSubstr("a motor of 160 Hz  plays it within"),
                      HasSubstr("of the device's range")));
    EXPECT_THAT(read("felt.svg"), AllOf(StartsWith("<svg "), HasSubstr(">s<"), HasSubstr(">0.5<"),
                                        HasSubstr("transients"), Not(HasSubstr("nan")), HasSubstr("</svg>")));
    const auto figures = nlohmann::json::parse(run("inspect felt.ahap --json").output);
    EXPECT_EQ(figures["format"], "ahap");
    EXPECT_NEAR(figures["seconds"].get<double>(), 0.7, 1e-6);
}

TEST_F(ClipsCommandTest, WhatCannotBeWrittenOrShownIsRefusedWithASentence) {
    write("click.haptic", R"({"version":{"major":1},"signals":{"continuous":{"envelopes":{"amplitude":[]}}}})");
    std::filesystem::create_directory(at("pictures"));
    write("pictures/cat.png", "meow");
    const std::string render = "render scene.json --stroke stroke.csv ";
    expectRefusals({
        {render + "-o one.ahap -o other.ahap", 2, "-o other.ahap: -o one.ahap is of the same kind"},
        {render + "-o one.wav -o one.haptic --rate 44100", 2,
         "-o one.haptic needs a --rate that is a multiple of 2000 Hz"},
        {"inspect click.haptic", 3, "click.haptic: clip key \"signals.continuous.envelopes.amplitude\": expected"},
        {"inspect " + testing::tinyModel + " --picture tiny.svg", 2, "--picture draws clips"},
        {"export-set -o pictures --labels wood", 2, "has other files and no index.json"},
        {"export-set -o set --labels wood --speeds 0.2,0.1", 2, "--speeds: expected rising numbers"},
        {"export-set -o set --labels sandpapr", 3, "sandpaper"},
    });
}

TEST_F(ClipsCommandTest, ASetHasALoopForEachLabelSpeedAndForceAndAnIndex) {
    const Finished exported =
        run("export-set -o set --labels wood,Sandpaper --speeds 0.05,0.2 --forces 1 --seconds 1 --formats wav,haptic "
            "--quality sketch --quiet");
    ASSERT_EQ(exported.exitCode, 0) << exported.errors;
    const auto index = nlohmann::json::parse(read("set/index.json"));
    EXPECT_EQ(index["format"], "haptoflow clip set");
    ASSERT_EQ(index["labels"].size(), 2U);
    EXPECT_EQ(index["labels"][1]["label"], "sandpaper") << "as the model spells it";
    std::set<std::string> files;
    for (const auto& label : index["labels"]) {
        double levelBefore = 0.0;
        ASSERT_EQ(label["clips"].size(), 2U);
        for (const auto& clip : label["clips"]) {
            EXPECT_GT(clip["rms_mps2"].get<double>(), levelBefore) << "faster is stronger";
            levelBefore = clip["rms_mps2"];
            const Recording wav = readRecording("the loop", at("set/" + clip["files"]["wav"].get<std::string>()));
            EXPECT_EQ(wav.rateHz, 48000.0);
            EXPECT_NEAR(static_cast<double>(wav.samples.size()), 48000.0 * clip["seconds"].get<double>(), 1.0);
            // No step where it closes: not above the largest one inside.
            float largest = 0.0F;
            for (std::size_t i = 1; i < wav.samples.size(); ++i) {
                largest = std::max(largest, std::abs(wav.samples[i] - wav.samples[i - 1]));
            }
            EXPECT_LE(std::abs(wav.samples.front() - wav.samples.back()), largest);
            files.insert(clip["files"]["wav"].get<std::string>());
            files.insert(clip["files"]["haptic"].get<std::string>());
        }
    }
    EXPECT_EQ(files.size(), 8U);
    for (const std::string& file : files) {
        EXPECT_TRUE(exists("set/" + file)) << file;
    }
    // The same words again replace the files.
    EXPECT_EQ(
        run("export-set -o set --labels wood --speeds 0.05 --forces 1 --seconds 1 --quality sketch --quiet").exitCode,
        0);
}

}  // namespace
}  // namespace haptoflow::cli
