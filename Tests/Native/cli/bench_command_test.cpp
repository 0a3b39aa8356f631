#include "command_line.hpp"

#include "bench/latency_bench.hpp"
#include "bench/measurements.hpp"

#include <nlohmann/json.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace haptoflow::cli {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using Json = nlohmann::json;

using testing::Finished;
using testing::tinyModel;

const std::string goldenSkeleton = HAPTOFLOW_TEST_GOLDEN_DIR "/model/skeleton.haptoflow";

/// The report of a run with few events; the tiny model replaces the paper's architecture, too.
Json reportOf(const std::string& measurements, const std::string& model = tinyModel) {
    const std::string only = measurements == "all" ? "" : " --only " + measurements;
    const Finished run = testing::runHaptoFlow("bench --quick --events 2 --json --model " + model + " --paper-model " +
                                               tinyModel + only);
    if (run.exitCode != 0) {
        throw std::runtime_error("bench ended with " + std::to_string(run.exitCode) + ": " + run.errors);
    }
    return Json::parse(run.output);
}

void expectRanked(const Json& figures, const std::string& where) {
    const double p50 = figures.at("p50");
    const double p99 = figures.at("p99");
    const double worst = figures.at("worst");
    EXPECT_GE(figures.at("count"), 1) << where;
    EXPECT_LE(p50, p99) << where;
    EXPECT_LE(p99, worst) << where;
    EXPECT_GT(worst, 0.0) << where;
}

void expectRatio(const Json& ratio, const Json& numerator, const Json& denominator, const std::string& where) {
    const double expected = numerator.get<double>() / denominator.get<double>();
    EXPECT_NEAR(ratio.get<double>(), expected, 1e-5 * expected) << where;
}

/// Every distribution of the report is ranked.
void expectRankedWithin(const Json& node, const std::string& where) {
    if (node.is_object() && node.contains("count") && node.contains("p99")) {
        expectRanked(node, where);
    }
    for (const auto& [key, child] : node.items()) {
        if (child.is_structured()) {
            expectRankedWithin(child, where + "/" + key);
        }
    }
}

/// Values of a key in rows, as text.
std::string valuesOf(const Json& rows, const std::string& key) {
    Json values = Json::array();
    for (const Json& row : rows) {
        values.push_back(row[key]);
    }
    return values.dump();
}

using BenchCommandTest = testing::CommandLineTest;

TEST_F(BenchCommandTest, TheReportHoldsEveryFigureOfTheContractWithTheRatioToItsReference) {
    const Json report = reportOf("all");
    expectRankedWithin(report, "");
    const auto expectRatioTo = [](const Json& row, const Json& reference) {
        expectRatio(row["ratio"], row["p50"], reference["p50"], row.dump());
    };

    EXPECT_EQ(valuesOf(report["callback_us"], "voices"), "[1,2,8]");
    for (const Json& row : report["callback_us"]) {
        for (const Json& pace : {row, row["paced"]}) {
            expectRatioTo(pace, pace["silence"]);
            expectRatio(pace["percent_of_block"]["p99"], pace["p99"], 5333.3333 / 100.0, "share of the block");
        }
    }

    EXPECT_EQ(valuesOf(report["effects"], "name"),
              R"(["texture","tone","impact","edge","relief","clip","delay","compensation","exposure guard","signal"])");
    for (const Json& row : report["effects"]) {
        EXPECT_EQ(row["off"]["runs"], 0) << row["name"];
        EXPECT_GT(row["on"]["runs"], 0) << row["name"];
        EXPECT_GT(row["on"]["us_per_block"].get<double>(), 0.0);
        expectRatio(row["on"]["ratio"], row["on"]["callback_us"]["p50"], row["off"]["callback_us"]["p50"], "effect");
    }

    ASSERT_EQ(report["inference_ms"].size(), 5U);
    for (const Json& tier : report["inference_ms"]) {
        expectRatio(tier["ratio"], report["paper_architecture_ms"]["p50"], tier["p50"], tier.dump());
    }
    EXPECT_EQ(report["speedup_vs_paper_architecture"], report["inference_ms"]["standard"]["ratio"]);
    EXPECT_EQ(report["speedup_vs_paper_architecture_paced"], report["inference_ms"]["standard"]["paced"]["ratio"]);

    EXPECT_EQ(valuesOf(report["voices"], "count"), "[1,2,4,8,16,32,64]");
    for (const Json& row : report["voices"]) {
        EXPECT_EQ(row["ms_per_update"], row["batched"]["p50"]);
        expectRatio(row["ratio"], row["batched"]["p50"], row["one_by_one"]["p50"], "voices");
    }
    EXPECT_FALSE(report.contains("sketch_voices")) << "the tiny model has no skeleton";

    EXPECT_EQ(report["idle"]["inferences"], 0);
    EXPECT_EQ(report["idle"]["worker_wakes"], 0);
    EXPECT_GE(report["idle"]["updates"], 4);

    const Json& memory = report["memory"];
    const double parts =
        memory["runtime_mib"].get<double>() + memory["model_mib"].get<double>() + memory["engine_mib"].get<double>();
    EXPECT_GT(parts, 1.0) << "ONNX Runtime alone is larger";
    EXPECT_NEAR(report["memory_mib"], parts, 1e-3);
    EXPECT_EQ(report["load_ms"], report["load"]["again"]["p50"]);

    ASSERT_EQ(report["notes"].size(), 1U) << report["notes"];
    EXPECT_THAT(report["notes"][0].get<std::string>(), HasSubstr("contact_to_sound_ms was not measured"));
    EXPECT_EQ(report["model"]["file"], "tiny.haptoflow");
    EXPECT_FALSE(report["machine"]["processor"].get<std::string>().empty());
    std::array<char, 256> host{};
    ASSERT_EQ(gethostname(host.data(), host.size() - 1), 0);
    // A very short host name would occur in any text.
    EXPECT_TRUE(std::string(host.data()).size() < 4 || report.dump().find(host.data()) == std::string::npos);
}

TEST_F(BenchCommandTest, LatenciesHaveARowForEachDeviceWithItsGoalAfterTheDefaultBlocksFigures) {
    const Json report = reportOf("latency,voices", goldenSkeleton);
    expectRankedWithin(report, "");
    EXPECT_EQ(report["sketch_voices"].size(), 7U);
    for (const char* key : {"onset_ms", "contact_to_sound_ms", "stop_ms"}) {
        const Json& section = report[key];
        ASSERT_EQ(section["rows"].size(), 3U) << key;
        EXPECT_EQ(section["block_frames"], 256) << key;
        EXPECT_EQ(section["p99"], section["rows"][0]["p99"]) << key;
        for (const Json& row : section["rows"]) {
            expectRatio(row["ratio"], row["p99"], row["goal"], key);
            EXPECT_GE(row["within_goal"], 0.0) << key;
            EXPECT_LE(row["within_goal"], 1.0) << key;
        }
    }
    for (std::size_t device = 0; device < 3; ++device) {
        const Json& onset = report["onset_ms"]["rows"][device];
        const double period = onset["block_frames"].get<double>() * onset["burst_blocks"].get<double>() / 48.0;
        EXPECT_NEAR(onset["goal"], period, 1e-3);
        EXPECT_NEAR(report["stop_ms"]["rows"][device]["goal"], period + 5.0, 1e-3);
        const Json& step = report["contact_to_sound_ms"]["rows"][device];
        EXPECT_NEAR(step["filter_delay"], 1.2, 0.1);
        EXPECT_NEAR(step["goal"], period + step["filter_delay"].get<double>() + 1.5, 1e-2);
    }
}

TEST_F(BenchCommandTest, WithoutThePapersModelTheReportHasANoteAndNoSpeedUp) {
    const Finished finished = run("bench --only inference --events 1 --model " + tinyModel + " -o bench.json");
    ASSERT_EQ(finished.exitCode, 0) << finished.errors;
    EXPECT_THAT(finished.output,
                AllOf(HasSubstr("inference, one segment"), HasSubstr("note: speedup_vs_paper_architecture")));
    EXPECT_THAT(finished.output, Not(HasSubstr("callback")));
    EXPECT_EQ(finished.errors, "") << "no progress bar if standard error is not a terminal";
    const Json report = Json::parse(read("bench.json"));
    EXPECT_FALSE(report.contains("speedup_vs_paper_architecture"));
    EXPECT_FALSE(report.contains("callback_us"));
    EXPECT_TRUE(report.contains("load_ms"));
    ASSERT_EQ(report["notes"].size(), 1U);
    EXPECT_THAT(report["notes"][0].get<std::string>(), HasSubstr("--paper-model"));
}

TEST_F(BenchCommandTest, WrongUseExitsWithTwoAndWrongFilesWithThree) {
    expectRefusals(
        {
            {"--only latncy", 2, "latncy"},
            {"--events 0", 2, "--events"},
            {"--model /nowhere/a.haptoflow", 3, "/nowhere/a.haptoflow: there is no such file"},
            {"--model " + tinyModel + " --paper-model /nowhere/p.haptoflow", 3, "/nowhere/p.haptoflow"},
            {"--model " + tinyModel + " -o /nowhere/bench.json", 3, "/nowhere/bench.json: cannot be written"},
        },
        "bench ");
}

TEST(BenchDistributionTest, PercentilesAreMeasuredValuesByNearestRank) {
    std::vector<double> values(200);
    std::iota(values.begin(), values.end(), 1.0);
    std::ranges::reverse(values);
    const bench::Distribution distribution = bench::distributionOf(values);
    EXPECT_EQ(distribution.p50, 100.0);
    EXPECT_EQ(distribution.p99, 198.0);
    EXPECT_EQ(distribution.worst, 200.0);
    EXPECT_EQ(bench::distributionOf({3.0}).p99, 3.0);
    EXPECT_THROW((void)bench::distributionOf({}), std::invalid_argument);
}

/// A recording of blocks of 10 frames at 1 kHz from time 100 s on, without gaps.
bench::Recording recordingOf(std::vector<float> samples) {
    bench::Recording recording;
    recording.rateHz = 1000.0;
    recording.samples = std::move(samples);
    for (std::size_t frame = 0; frame < recording.samples.size(); frame += 10) {
        recording.blocks.push_back(
            {.playsAtSeconds = 100.0 + 0.001 * static_cast<double>(frame), .firstFrame = frame, .frames = 10});
    }
    return recording;
}

TEST(BenchLatencyTest, OnsetAndStopAreTheFirstAndLastSampleWithinSixtyDecibelsOfThePeak) {
    std::vector<float> samples(100, 0.0F);
    std::fill(samples.begin() + 30, samples.begin() + 60, -0.5F);
    samples[20] = 0.0004F;
    samples[65] = 0.0006F;
    samples[80] = 0.0004F;
    const bench::Recording recording = recordingOf(samples);
    bench::TouchScript script;
    script.touches = {{.down = 0, .lift = 1}};
    const std::vector<double> published{100.0105, 100.0505, 100.1};
    bench::Latencies onsets;
    bench::Latencies stops;
    const bench::DeviceShape shape{.blockFrames = 480, .burstBlocks = 2};
    bench::findOnsets(recording, published, script, shape, onsets);
    bench::findStops(recording, published, script, shape, stops);
    ASSERT_EQ(onsets.seconds.size(), 1U);
    EXPECT_NEAR(onsets.seconds[0], 0.0195, 1e-9);
    EXPECT_NEAR(onsets.goalSeconds[0], 0.02, 1e-9);
    ASSERT_EQ(stops.seconds.size(), 1U);
    EXPECT_NEAR(stops.seconds[0], 0.0155, 1e-9) << "to the end of that sample";
    EXPECT_NEAR(stops.goalSeconds[0], 0.025, 1e-9);
}

TEST(BenchLatencyTest, ASilentTouchIsCountedAsMissed) {
    bench::TouchScript script;
    script.touches = {{.down = 0, .lift = 1}};
    bench::Latencies onsets;
    bench::findOnsets(recordingOf(std::vector<float>(50, 0.0F)), {100.0, 100.02, 100.05}, script, {}, onsets);
    EXPECT_TRUE(onsets.seconds.empty());
    EXPECT_EQ(onsets.missed, 1U);
}

TEST(BenchLatencyTest, ALabelChangeIsFoundAtTheFirstSampleThatOnlyTheLoudLabelHas) {
    constexpr float fullScale = 60.0F;
    std::vector<float> samples(100, 3.0F * bench::quietMps2 / fullScale);
    std::fill(samples.begin() + 40, samples.end(), -0.3F * bench::loudMps2 / fullScale);
    bench::StepScript script;
    script.steps = {1};
    bench::Latencies steps;
    bench::findSteps(recordingOf(samples), {100.0, 100.0155, 100.03}, script, {}, 0.0012, fullScale, steps);
    ASSERT_EQ(steps.seconds.size(), 1U);
    EXPECT_NEAR(steps.seconds[0], 0.0245, 1e-9);
    EXPECT_NEAR(steps.goalSeconds[0], 256.0 / 48000.0 + 0.0012 + 0.0015, 1e-9);
}

TEST(BenchLatencyTest, AMarkingSkeletonIsWhiteNoiseAtTheLevelOfItsLabel) {
    const auto model = model::ModelFile::read(goldenSkeleton);
    const skeleton::NativeParts marking = bench::markingParts(model, 0, 1);
    inference::SkeletonGenerator generator(marking, 1);
    std::array<float, 200> noise{};
    noise.fill(0.5F);
    const std::array<float, 200> silence{};
    for (const auto& [label, expected] : {std::pair{0U, bench::quietMps2}, std::pair{1U, bench::loudMps2}}) {
        inference::SegmentRequest request{
            .embedding = {}, .motion = {0.1F, 0.05F, 1.0F}, .previous = silence, .noise = noise};
        std::ranges::copy(model.embedding(label), request.embedding.begin());
        std::array<float, 200> segment{};
        generator.generate(std::span(&request, 1), segment);
        EXPECT_NEAR(segment[0] / (0.5F * expected), 1.0F, 1e-3F) << label;
        EXPECT_NEAR(segment[199] / (0.5F * expected), 1.0F, 1e-3F) << label;
    }
}

}  // namespace
}  // namespace haptoflow::cli
