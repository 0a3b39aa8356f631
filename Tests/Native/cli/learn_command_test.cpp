// `haptoflow learn`: recordings of every format become material files that render uses.
#include "command_line.hpp"

#include "learning/made_recording.hpp"
#include "learning/texture_figures.hpp"
#include "material_output.hpp"
#include "messages.hpp"
#include "model/material_file.hpp"
#include "model/model_file.hpp"
#include "recordings/recording_reader.hpp"
#include "recordings/resampling.hpp"
#include "wav_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sndfile.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

namespace haptoflow::cli {
namespace {

using learning::testing::MadeMotion;
using learning::testing::MadeRecording;
using learning::testing::MadeSurface;
using testing::Finished;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr double rateHz = 4000.0;

class LearnCommandTest : public testing::CommandLineTest {
protected:
    /// time_s, acceleration_mps2, velocity and force of a generated recording.
    [[nodiscard]] static std::string csvOf(
        const MadeRecording& made,
        const std::string& columns = "time_s,acceleration_mps2,velocity_x_mps,velocity_y_mps,force_newtons") {
        std::ostringstream text;
        text << columns << '\n';
        for (std::size_t i = 0; i < made.acceleration.size(); ++i) {
            text << static_cast<double>(i) / rateHz << ',' << made.acceleration[i] << ',' << made.velocity[2 * i] << ','
                 << made.velocity[2 * i + 1] << ',' << made.force[i] << '\n';
        }
        return text.str();
    }

    void writeWav(const std::string& name, const MadeRecording& made, float fullScale) const {
        WavWriter writer(at(name), static_cast<int>(rateHz), name);
        std::vector<float> samples = made.acceleration;
        std::ranges::transform(samples, samples.begin(), [&](float value) { return value / fullScale; });
        writer.write(samples);
        writer.close();
    }

    /// Learns with the tiny model, whose networks are fast.
    [[nodiscard]] Finished learn(const std::string& words) const {
        return run("learn " + words + " --model '" + testing::tinyModel + "'");
    }

    [[nodiscard]] recordings::MaterialRecording readHere(const std::string& name,
                                                         const recordings::RecordingWords& words = {}) const {
        recordings::DiskFiles files;
        return recordings::readMaterialRecording(files, at(name), words);
    }

    void expectRefused(const std::string& words, const std::string& said, int exitCode = 3) const {
        const std::size_t files = fileCount();
        const Finished finished = learn(words + " -o refused.haptomaterial");
        EXPECT_EQ(finished.exitCode, exitCode) << finished.errors;
        EXPECT_THAT(finished.errors, HasSubstr(said));
        EXPECT_EQ(fileCount(), files) << "a file remained";
    }

    const MadeRecording made_{{}, {}};
    const std::string csv_ = csvOf(made_);
};

TEST_F(LearnCommandTest, ATableGivesAMaterialFileAndAReportWithEqualBytesEachTime) {
    write("denim.csv", csv_);
    const Finished first = learn("denim.csv --report denim.report.json --licence 'CC BY 4.0' --category fabric");
    ASSERT_EQ(first.exitCode, 0) << first.errors;
    EXPECT_THAT(first.output, HasSubstr("Learnt denim from 10.0 s of sliding"));
    EXPECT_THAT(first.output, HasSubstr("nearest label"));
    const model::MaterialFile material = model::readMaterial(at("denim.haptomaterial"));
    EXPECT_EQ(material.label.name, "denim");
    EXPECT_EQ(material.label.category, "fabric");
    EXPECT_EQ(material.provenance.licence, "CC BY 4.0");
    EXPECT_EQ(material.provenance.recordings, "denim.csv");
    EXPECT_NEAR(nlohmann::json::parse(read("denim.report.json"))["speed_mps"][1].get<double>(), 0.25, 0.02);
    const std::string before = read("denim.haptomaterial");
    ASSERT_EQ(learn("denim.csv --licence 'CC BY 4.0' --category fabric --quiet").exitCode, 0);
    EXPECT_EQ(read("denim.haptomaterial"), before);
}

TEST_F(LearnCommandTest, ReportAndPictureShowRecordingMaterialAndNearestLabelAtEachSpeed) {
    write("denim.csv", csv_);
    const Finished finished = learn("denim.csv --report denim.report.json --picture denim.svg --quiet");
    ASSERT_EQ(finished.exitCode, 0) << finished.errors;
    const nlohmann::json report = nlohmann::json::parse(read("denim.report.json"));
    const nlohmann::json& spectra = report["spectra"];
    ASSERT_GE(spectra["speeds"].size(), 3U);
    double seconds = 0.0;
    for (const nlohmann::json& each : spectra["speeds"]) {
        seconds += each["seconds"].get<double>();
        for (const char* curve : {"recorded", "learnt", "nearest_label"}) {
            EXPECT_EQ(each[curve]["decibels"].size(), spectra["frequencies_hz"].size());
        }
        // The made surface's law at 1 N, which the recording is drawn from and the material follows.
        const double wanted = 1.5 * std::pow(each["speed_mps"].get<double>() / 0.1, 0.9);
        EXPECT_NEAR(each["recorded"]["rms_mps2"].get<double>() / wanted, 1.0, 0.35);
        EXPECT_NEAR(each["learnt"]["rms_mps2"].get<double>() / each["recorded"]["rms_mps2"].get<double>(), 1.0, 0.2);
    }
    EXPECT_NEAR(seconds, 10.0, 1.5);
    const nlohmann::json& levels = report["levels"];
    ASSERT_EQ(levels["forces"].size(), 2U);
    for (const nlohmann::json& force : levels["forces"]) {
        EXPECT_EQ(force["learnt_mps2"].size(), levels["speeds_mps"].size());
        EXPECT_EQ(force["nearest_label_mps2"].size(), levels["speeds_mps"].size());
        EXPECT_LT(force["recorded_speed_mps"][0].get<double>(), force["recorded_speed_mps"][1].get<double>());
        for (const nlohmann::json& each : force["speeds"]) {
            EXPECT_GT(each["recorded"]["frames"].get<int>(), 0);
            EXPECT_NEAR(each["recorded"]["kurtosis"].get<double>(), 3.0, 1.5);
            EXPECT_TRUE(each["recorded"]["ribs_db"][0].is_null()) << "no ribs were found";
        }
    }
    const std::string picture = read("denim.svg");
    for (const char* words : {"recorded 31 to ", "extrapolated", "kurtosis"}) {
        EXPECT_THAT(picture, HasSubstr(words));
    }
    EXPECT_THAT(picture, Not(HasSubstr("ribs"))) << "no ribs were found";
    for (const std::string& words : {std::string("recorded, "), std::string("learnt, "),
                                     "nearest label, " + report["nearest_label"].get<std::string>()}) {
        EXPECT_THAT(picture, HasSubstr(words));
    }
    EXPECT_THAT(finished.output, HasSubstr("to gain most       record more of the same"));
    EXPECT_THAT(report["record_next"].get<std::string>(), HasSubstr("20 s of sliding or more"));
}

TEST_F(LearnCommandTest, TheSensorsNoiseIsRemovedAndReported) {
    write("noisy.csv", csvOf(learning::testing::noisy(made_)));
    const Finished finished = learn("noisy.csv --report noisy.report.json --quiet");
    ASSERT_EQ(finished.exitCode, 0) << finished.errors;
    EXPECT_THAT(finished.output, HasSubstr("m/s^2 RMS, removed; found where the tip rests"));
    const nlohmann::json noise = nlohmann::json::parse(read("noisy.report.json"))["sensor_noise"];
    EXPECT_EQ(noise["from"], "rest");
    EXPECT_NEAR(noise["mps2"].get<double>(), 0.028, 0.003);
    write("clean.csv", csv_);
    EXPECT_THAT(learn("clean.csv --quiet").output, HasSubstr("sensor noise       none found, so nothing was removed"));
}

TEST_F(LearnCommandTest, ARecordingOfNothingButNoiseIsRefused) {
    MadeRecording silent = made_;
    std::ranges::fill(silent.acceleration, 0.0F);
    write("silent.csv", csvOf(learning::testing::noisy(silent)));
    expectRefused("silent.csv", "silent.csv: the acceleration is no stronger where the tip slides than where it rests");
}

TEST_F(LearnCommandTest, TheDistanceOfRibsAndTheAngleOfTheMaterialAreReported) {
    write("ribbed.csv", csvOf(MadeRecording({.ribs = {0.8, 0.45}, .ribShare = 0.5}, {})));
    const Finished finished = learn("ribbed.csv --report ribbed.report.json --quiet");
    ASSERT_EQ(finished.exitCode, 0) << finished.errors;
    EXPECT_THAT(finished.output, HasSubstr("every 1.09 mm; the material's first axis lies across them, 29 degrees from "
                                           "the recording's"));
    EXPECT_NEAR(nlohmann::json::parse(read("ribbed.report.json"))["turn_degrees"].get<double>(), 29.36, 1.0);
}

TEST_F(LearnCommandTest, TheSidecarOfAWavScalesAndNamesIt) {
    writeWav("mat.wav", made_, 50.0F);
    write("mat.json", R"({"label": "Doormat", "full_scale_mps2": 50, "speed_mps": 0.08, "force_newtons": 0.8,
                          "licence": "CC0", "source": "our hall"})");
    const Finished finished = learn("mat.wav");
    ASSERT_EQ(finished.exitCode, 0) << finished.errors;
    EXPECT_THAT(finished.errors, HasSubstr("the speed hardly changes"));
    const model::MaterialFile material = model::readMaterial(at("mat.haptomaterial"));
    EXPECT_EQ(material.label.name, "doormat");
    EXPECT_EQ(material.provenance.licence, "CC0");
    EXPECT_EQ(material.provenance.recordings, "mat.wav, our hall");
    EXPECT_DOUBLE_EQ(material.speedMps[1], 0.08);
}

TEST_F(LearnCommandTest, TheCommandLineReplacesTheSidecarAndTheSidecarReplacesTheFoldersDefaults) {
    writeWav("mat.wav", made_, 50.0F);
    write("recordings.json", R"({"full_scale_mps2": 10, "velocity_mps": [0.0, 0.1], "force_newtons": 0.5})");
    write("mat.json", R"({"full_scale_mps2": 50, "speed_mps": 0.2})");
    const recordings::MaterialRecording recording = readHere("mat.wav", {.forceNewtons = 1.5});
    EXPECT_NEAR(recording.accelerationMps2[1000], made_.acceleration[1000], 1e-3);
    EXPECT_EQ(recording.constantVelocityMps, (std::array{0.2, 0.0}));
    EXPECT_EQ(recording.constantForceNewtons, 1.5);
}

TEST_F(LearnCommandTest, PositionsOfASlowTrackerGiveTheSpeedAndUnevenTimesAreResampled) {
    std::ostringstream text;
    text
        << "time_s,acceleration_x_g,acceleration_y_g,acceleration_z_g,position_x_mm,position_y_mm,force_millinewtons\n";
    double time = 0.0;
    for (int i = 0; i < 24'000; ++i) {
        time += 0.00045 + 0.0001 * ((i * 7919) % 1000) / 1000.0;
        const double read = std::floor(time * 100.0) / 100.0;
        text << time << ',' << 0.3 * std::sin(2.0 * std::numbers::pi * 150.0 * time) << ",0.01,-1,"
             << std::round(80.0 * read * 100.0) / 100.0 << ",5," << 900 << '\n';
    }
    write("tracked.csv", text.str());
    const recordings::MaterialRecording recording = readHere("tracked.csv");
    EXPECT_EQ(recording.axisCount, 3U);
    EXPECT_NEAR(recording.rateHz, 2000.0, 2.0);
    const std::size_t middle = recording.accelerationMps2.size() / 6;
    EXPECT_NEAR(recording.velocityMps[2 * middle], 0.08, 0.002);
    EXPECT_NEAR(recording.velocityMps[2 * middle + 1], 0.0, 0.002);
    EXPECT_NEAR(recording.forceNewtons[middle], 0.9, 1e-4);
    double sum = 0.0;
    for (std::size_t i = 0; i < recording.accelerationMps2.size(); i += 3) {
        sum += std::pow(recording.accelerationMps2[i], 2);
    }
    EXPECT_NEAR(std::sqrt(3.0 * sum / static_cast<double>(recording.accelerationMps2.size())),
                0.3 * 9.80665 / std::numbers::sqrt2, 0.05);
}

TEST_F(LearnCommandTest, AMotionFileHasItsOwnTimes) {
    write("felt.csv", csvOf(made_, "time_s,acceleration_mps2,a,b,c"));
    write("felt.json", R"({"motion": "felt.motion.csv"})");
    std::string motion = "time_s,speed_mmps,force_newtons\n";
    for (int i = -5; i < 1100; ++i) {
        motion += std::to_string(0.01 * i) + "," + std::to_string(50 + 0.05 * i) + ",0.7\n";
    }
    write("felt.motion.csv", motion);
    const recordings::MaterialRecording recording = readHere("felt.csv");
    EXPECT_NEAR(recording.velocityMps[2 * 20'000], 0.075, 1e-4);
    EXPECT_NEAR(recording.forceNewtons[20'000], 0.7, 1e-5);
    ASSERT_EQ(recording.description.notes.size(), 1U);
    EXPECT_THAT(recording.description.notes[0], HasSubstr("columns a, b, c are not known and are ignored"));
}

TEST_F(LearnCommandTest, GapsInTheTimesAndCellsWithoutANumberAreMissingSamples) {
    std::ostringstream text;
    text << "time_s,acceleration_mps2,speed_mps,force_newtons\n";
    for (int i = 0; i < 20'000; ++i) {
        const double time = i / 2000.0 + (i >= 10'000 ? 0.007 : 0.0);
        text << time << ',' << (i % 2 == 0 ? "0.5" : "-0.5") << ",0.1," << (i == 4000 ? "" : "1") << '\n';
    }
    write("gap.csv", text.str());
    const recordings::MaterialRecording recording = readHere("gap.csv");
    EXPECT_TRUE(std::isnan(recording.accelerationMps2[10'006]));
    EXPECT_FALSE(std::isnan(recording.accelerationMps2[9990]));
    EXPECT_FALSE(std::isnan(recording.accelerationMps2[10'030]));
    EXPECT_FLOAT_EQ(recording.forceNewtons[4000], 1.0F);
}

TEST_F(LearnCommandTest, ErrorsNameTheFileTheColumnOrKeyAndARemedy) {
    expectRefused("none.csv", "none.csv: does not exist");
    write("table.parquet", "PAR1");
    expectRefused("table.parquet", "expected a recording that ends with .csv, .wav or .w64");
    write("a.csv", "time_s,speed_mps,force_newtons\n0,1,1\n");
    expectRefused("a.csv",
                  "a.csv: columns time_s, speed_mps, force_newtons; expected acceleration: acceleration_mps2 | ");
    write("b.csv", csvOf(made_, "time_s,acceleration_mps2,a,b,force_newtons"));
    expectRefused("b.csv",
                  "b.csv: no motion in it or beside it; expected columns velocity_x_mps, velocity_y_mps | speed_mps");
    write("c.csv", csvOf(made_, "time_s,acceleration_mps2,velocity_x_mps,velocity_y_mps,c"));
    expectRefused("c.csv", "or --force-newtons");
    write("d.csv", csvOf(made_, "t,acceleration_mps2,velocity_x_mps,velocity_y_mps,force_newtons"));
    expectRefused("d.csv", "d.csv: no column time_s; expected a column time_s, or the key rate_hz in d.json");
    write("e.csv", csvOf(made_, "time_s,acceleration_mps2,velocity_x_mps,b,force_newtons"));
    expectRefused("e.csv", "without velocity_y_mps");
    write("f.csv", "time_s;acceleration_mps2;speed_mps\n0;1;2\n");
    expectRefused("f.csv", "f.csv: 1 rows; expected 4 rows at least");
    write("g.csv", "time_s,acceleration_mps2,speed_mps,force_newtons\n0,1,2,3\n0.001,x,2,3\n");
    expectRefused("g.csv", "g.csv:3: column acceleration_mps2: is \"x\"; expected a number with a decimal point");
    write("h.csv", "time_s,acceleration_mps2,speed_mps,force_newtons\n0,1,2,3\n0.001,1,2\n");
    expectRefused("h.csv", "h.csv:3: 3 values; expected 4 as in the first line");
    write("i.csv", "time_s,acceleration_mps2,speed_mps,force_newtons\n0,1,2,3\n1,1,2,3\n1,1,2,3\n2,1,2,3\n3,1,1,1\n");
    expectRefused("i.csv", "i.csv:4: column time_s: repeats the time before it");
    write("j.csv", "time_s,acceleration_mps2,speed_mps,force_newtons\n0,1,2,3\n1,1,2,3\n2,1,2,3\n3,1,2,3\n");
    expectRefused("j.csv", "1 samples a second by time_s; expected 1000 to 192000; time_s is in seconds");
    write("k.csv", csv_);
    write("k.json", R"({"speeds": 3})");
    expectRefused("k.csv", "k.json: unknown key 'speeds'; expected keys of label,");
    write("l.csv", csvOf(MadeRecording({}, {.seconds = 1.5})));
    expectRefused("l.csv", "l.csv: the recording lasts 1.5 s; record 10 s or more of sliding");
    writeWav("m.wav", made_, 50.0F);
    expectRefused("m.wav", "m.json: no key 'full_scale_mps2' for m.wav");
    write("n.wav", "no sound");
    expectRefused("n.wav --full-scale-mps2 50", "n.wav: not a RIFF WAVE file");
}

TEST_F(LearnCommandTest, ErrorsForImplausibleNumbersSuggestAUnit) {
    MadeRecording fast = made_;
    std::ranges::transform(fast.velocity, fast.velocity.begin(), [](float value) { return 1000.0F * value; });
    write("fast.csv", csvOf(fast));
    expectRefused("fast.csv", "velocity_x_mps gives a speed of ");
    std::ostringstream text;
    text << "time_s,acceleration_x_mps2,acceleration_y_mps2,acceleration_z_mps2,speed_mps,force_newtons\n";
    for (int i = 0; i < 20'000; ++i) {
        text << i / 2000.0 << ',' << 0.1 * std::sin(i) << ",0,-1,0.1,1\n";
    }
    write("g.csv", text.str());
    expectRefused("g.csv", "acceleration_x_mps2 rests at 1, which looks like g");
}

TEST_F(LearnCommandTest, AForceWithTheOtherSignOrAnOffsetIsRefusedUntilTheCommandLineSaysWhatItMeans) {
    write("true.csv", csv_);
    ASSERT_EQ(learn("true.csv -o true.haptomaterial").exitCode, 0);
    const auto measured = [&](const std::string& name, float sign, float offset) {
        MadeRecording changed = made_;
        std::ranges::transform(changed.force, changed.force.begin(),
                               [&](float force) { return sign * force + offset; });
        write(name, csvOf(changed));
    };
    measured("turned.csv", -1.0F, 0.0F);
    expectRefused("turned.csv", "turned.csv: force_newtons is negative in 100 % of the sliding, between -");
    expectRefused("turned.csv", "give the key \"force_sign\": -1 in turned.json or --force-sign -1");
    measured("offset.csv", 1.0F, -0.75F);
    expectRefused("offset.csv", "subtract what it reads in the air, by the key \"force_rest_newtons\"");
    expectRefused("turned.csv --force-sign 2", "--force-sign", 2);
    EXPECT_EQ(learn("turned.csv --force-sign -1 --name true -o turned.haptomaterial").exitCode, 0);
    EXPECT_EQ(learn("offset.csv --force-rest-newtons -0.75 --name true -o offset.haptomaterial").exitCode, 0);
    const auto laws = [&](const std::string& name) {
        return nlohmann::json::parse(read(name)).at("level_exponents").dump();
    };
    EXPECT_EQ(laws("turned.haptomaterial"), laws("true.haptomaterial"));
    EXPECT_EQ(laws("offset.haptomaterial"), laws("true.haptomaterial"));
}

TEST_F(LearnCommandTest, OptionsThatContradictTheFileAreUsageErrors) {
    write("denim.csv", csv_);
    expectRefused("denim.csv --speed-mps 0.1", "--speed-mps: denim.csv has a motion of its own", 2);
    expectRefused("denim.csv --force-newtons 1", "--force-newtons: denim.csv has a force of its own", 2);
    expectRefused("denim.csv --full-scale-mps2 10", "--full-scale-mps2 is for WAV", 2);
    expectRefused("denim.csv --name Denim", "--name 'Denim': expected 1 to 128 characters without capital letters", 2);
    EXPECT_EQ(learn("denim.csv -o denim.csv").exitCode, 2);
    EXPECT_EQ(read("denim.csv"), csv_);
}

TEST_F(LearnCommandTest, ALabelInASidecarNamesTheMaterialAndNeverAFile) {
    std::filesystem::create_directories(at("work"));
    std::filesystem::create_directories(at("victim"));
    write("victim/wood.haptomaterial", "mine");
    write("work/wood.haptomaterial", "mine, too");
    write("work/denim.csv", csv_);
    for (const std::string& label :
         {at("victim/wood").string(), std::string("a/b"), std::string("wood"), std::string("../victim/wood")}) {
        write("work/denim.json", nlohmann::json({{"label", label}}).dump());
        const Finished finished = run("--version && cd work && '" HAPTOFLOW_TEST_CLI "' learn denim.csv --model '" +
                                      testing::tinyModel + "'");
        ASSERT_EQ(finished.exitCode, 0) << finished.errors;
        EXPECT_EQ(read("victim/wood.haptomaterial"), "mine");
        EXPECT_EQ(read("work/wood.haptomaterial"), "mine, too");
    }
    EXPECT_EQ(model::readMaterial(at("work/denim.haptomaterial")).label.name, "../victim/wood");
}

TEST_F(LearnCommandTest, ANameOfTheCommandLineBecomesAFileNameInThisFolder) {
    EXPECT_EQ(fileNameOf("../victim/wood"), "victim-wood");
    EXPECT_EQ(fileNameOf("C:\\temp\\wood"), "C--temp-wood");
    EXPECT_EQ(fileNameOf("kitchen tile"), "kitchen tile");
    EXPECT_EQ(fileNameOf(".."), "material");
    EXPECT_EQ(fileNameOf(".hidden\n"), "hidden");
    EXPECT_EQ(fileNameOf("caf\xC3\xA9"), "caf\xC3\xA9");
    write("denim.csv", csv_);
    const Finished finished = learn("denim.csv --name ../victim/wood");
    ASSERT_EQ(finished.exitCode, 0) << finished.errors;
    EXPECT_EQ(model::readMaterial(at("victim-wood.haptomaterial")).label.name, "../victim/wood");
}

TEST_F(LearnCommandTest, AMotionFileDoesNotLeaveTheFolderOfItsSidecar) {
    std::filesystem::create_directories(at("in"));
    std::string motion = "time_s,speed_mps,force_newtons\n";
    for (int reading = 0; reading <= 60; ++reading) {
        motion += std::to_string(0.2 * reading) + ",0.1,1\n";
    }
    write("secret.csv", motion);
    write("in/near.csv", read("secret.csv"));
    std::filesystem::create_symlink(at("secret.csv"), at("in/link.csv"));
    write("in/felt.csv", csvOf(made_, "time_s,acceleration_mps2,a,b,c"));
    for (const std::string& name : {std::string("../secret.csv"), at("secret.csv").string(), std::string("link.csv"),
                                    std::string("x/../../secret.csv")}) {
        write("in/felt.json", nlohmann::json({{"motion", name}}).dump());
        expectRefused("in/felt.csv", "in/felt.json: key 'motion' names " + name + ", which is outside the folder");
    }
    write("in/felt.json", R"({"motion": "../in/./near.csv"})");
    EXPECT_FALSE(readHere("in/felt.csv").velocityMps.empty());
}

TEST_F(LearnCommandTest, TextsThatAMaterialFileMayNotHoldAreRefusedBeforeTheFit) {
    write("denim.csv", csv_);
    const std::string expected = "expected one line of text in UTF-8, without control characters";
    expectRefused("denim.csv --category \"$(printf 'a\\tb')\"", "--category 'a\\x09b'", 2);
    expectRefused("denim.csv --licence \"$(printf 'CC\\nBY')\"", "--licence 'CC\\x0ABY': " + expected, 2);
    expectRefused("denim.csv --licence \"$(printf 'CC\\377')\"", "--licence 'CC\\xFF': " + expected, 2);
    expectRefused("denim.csv --licence " + std::string(5000, 'a'), "4096 bytes at most", 2);
    expectRefused("denim.csv --category " + std::string(200, 'a'), "128 bytes at most", 2);
    expectRefused("denim.csv --name ' '", "not all blank", 2);
    expectRefused("denim.csv --name \"$(printf 'a\\tb')\"", "--name 'a\\x09b'", 2);
    for (const std::string key : {"licence", "source", "label"}) {
        write("denim.json", nlohmann::json({{key, "CC\nBY\x1b[2J"}}).dump());
        expectRefused("denim.csv", "denim.json: key '" + key + "' is ");
        write("denim.json", nlohmann::json({{key, std::string(5000, 'a')}}).dump());
        expectRefused("denim.csv", "denim.json: key '" + key + "' is ");
    }
    write("denim.json", nlohmann::json({{"source", std::string(4090, 'a')}}).dump());
    expectRefused("denim.csv", "denim.csv: recordings is ");
}

TEST_F(LearnCommandTest, AFileNameOfAnyBytesGivesAMaterialThatTheLibraryReads) {
    const std::string name = "caf\xE9\x1b[2J\n.csv";
    write(name, csv_);
    const Finished finished = learn("\"$(printf 'caf\\351\\033[2J\\n.csv')\" -o made.haptomaterial --report made.json");
    ASSERT_EQ(finished.exitCode, 0) << finished.errors;
    EXPECT_THAT(finished.output + finished.errors, Not(HasSubstr("\x1b")));
    const model::MaterialFile material = model::readMaterial(at("made.haptomaterial"));
    EXPECT_EQ(material.label.name, "caf  [2j");
    EXPECT_EQ(material.provenance.recordings, "caf\\xE9\\x1B[2J\\x0A.csv");
    // A long name is cut between characters.
    std::string longName = "x";
    for (int i = 0; i < 70; ++i) {
        longName += "\xC3\xA9";
    }
    write(longName + ".csv", csv_);
    ASSERT_EQ(learn(longName + ".csv -o made.haptomaterial").exitCode, 0);
    EXPECT_EQ(model::readMaterial(at("made.haptomaterial")).label.name.size(), 127U);
}

TEST_F(LearnCommandTest, AMaterialThatCannotBeReadBackIsNotWrittenAndTheOldFileStays) {
    write("old.haptomaterial", "old");
    const model::ModelFile model = model::ModelFile::read(testing::tinyModel);
    {
        OutputFile output("-o", at("old.haptomaterial"));
        EXPECT_THAT([&] { writeMaterial(output, "{\"format\": \"haptoflow-material\"}", model.header()); },
                    ::testing::ThrowsMessage<InputError>(HasSubstr("old.haptomaterial: was not written")));
    }
    EXPECT_EQ(read("old.haptomaterial"), "old");
    EXPECT_EQ(fileCount(), 3U) << "the scene, the stroke and the old file";
}

TEST_F(LearnCommandTest, APauseOfAMinuteSplitsARecording) {
    std::ostringstream text;
    text << "time_s,acceleration_mps2,velocity_x_mps,velocity_y_mps,force_newtons\n";
    for (std::size_t i = 0; i < made_.acceleration.size(); ++i) {
        const double seconds = static_cast<double>(i) / rateHz + (i >= made_.acceleration.size() / 2 ? 60.0 : 0.0);
        text << seconds << ',' << made_.acceleration[i] << ',' << made_.velocity[2 * i] << ','
             << made_.velocity[2 * i + 1] << ',' << made_.force[i] << '\n';
    }
    write("paused.csv", text.str());
    const Finished finished = learn("paused.csv");
    ASSERT_EQ(finished.exitCode, 0) << finished.errors;
    EXPECT_THAT(finished.output, HasSubstr("Learnt paused from 9.9 s of sliding"));
}

TEST_F(LearnCommandTest, ControlCharactersOfAFileAreEscapedInMessages) {
    write("a.csv", "time_s,acc\x1b[31meleration,\x07\n0,1,2\n");
    const Finished columns = learn("a.csv");
    EXPECT_THAT(columns.errors, HasSubstr("acc\\x1B[31meleration, \\x07"));
    EXPECT_THAT(columns.errors, Not(HasSubstr("\x1b")));
    write("b.csv", csv_);
    write("b.json", "{\"\\u001b[2J\": 1}");
    EXPECT_THAT(learn("b.csv").errors, HasSubstr("unknown key '\\x1B[2J'"));
    write("scene.json", "{\"surf\\u009baces\": []}");
    EXPECT_THAT(render("-o felt.wav").errors, HasSubstr("surf\\xC2\\x9Baces"));
}

TEST_F(LearnCommandTest, HelpGivesExamples) {
    const Finished help = run("learn --help");
    EXPECT_EQ(help.exitCode, 0);
    EXPECT_THAT(help.output, HasSubstr("haptoflow learn denim.csv -o denim.haptomaterial"));
    EXPECT_THAT(help.output, HasSubstr("acceleration_mps2"));
    EXPECT_THAT(run("lern denim.csv").errors, HasSubstr("did you mean 'learn'?"));
}

/// Third-octave levels in dB of a wave at 2 kHz, from 50 to 400 Hz.
std::vector<double> bandsOf(const std::vector<float>& wave) {
    learning::TextureMeter meter(1);
    for (std::size_t at = 0; at + learning::spectrumSamples <= wave.size(); at += 64) {
        meter.add(0, std::span(wave).subspan(at).first<learning::spectrumSamples>(), {});
    }
    const learning::TextureFigures figures = meter.figures()[0];
    std::vector<double> bands;
    for (double centre = 50.0; centre < 450.0; centre *= std::exp2(1.0 / 3.0)) {
        double power = 0.0;
        for (std::size_t bin = 1; bin < learning::spectrumBins; ++bin) {
            const double hertz = static_cast<double>(bin) * learning::hertzPerBin;
            if (hertz >= centre * std::exp2(-1.0 / 6.0) && hertz < centre * std::exp2(1.0 / 6.0)) {
                power += figures.power[bin];
            }
        }
        bands.push_back(10.0 * std::log10(power));
    }
    return bands;
}

/// The wave at 2 kHz without its first and last 0.3 s.
std::vector<float> middleAt2kHz(const std::vector<float>& wave, double waveRateHz) {
    const std::vector<double> all = recordings::bandPassed(
        recordings::resampled({.first = wave.data(), .stride = 1, .count = wave.size()}, waveRateHz, 2000.0));
    return {all.begin() + 600, all.end() - 600};
}

TEST_F(LearnCommandTest, ALearntMaterialRendersLikeItsRecordingAtAGivenSpeed) {
    const MadeSurface surface{.levelAtReference = 2.0, .speedExponent = 0.8, .resonanceHz = 240.0};
    write("tile.csv", csvOf(MadeRecording(surface, {.seconds = 12.0})));
    const Finished learnt = run("learn tile.csv --quiet");
    ASSERT_EQ(learnt.exitCode, 0) << learnt.errors;

    write("scene.json", R"({"surfaces": [{"name": "floor", "shape": {"plane": {}}, "material": "tile"}]})");
    write("stroke.csv", "t,x,y,z,force\n0,0,0.0005,0,0.8\n6,0.54,0.0005,0,0.8\n");
    const Finished rendered =
        run("render scene.json --stroke stroke.csv --material tile.haptomaterial -o tile.wav "
            "--rate 8000 --quiet");
    ASSERT_EQ(rendered.exitCode, 0) << rendered.errors;

    // The reference: the same surface at 90 mm/s; only its force varies by half.
    const MadeRecording truth(surface, {.seconds = 12.0, .minimumSpeedMps = 0.09, .maximumSpeedMps = 0.09}, rateHz, 99);
    std::vector<float> heard = readRecording("the wave", at("tile.wav").string()).samples;
    std::ranges::transform(heard, heard.begin(), [](float value) { return 200.0F * value; });
    const std::vector<double> found = bandsOf(middleAt2kHz(heard, 8000.0));
    const std::vector<double> wanted = bandsOf(middleAt2kHz(truth.acceleration, rateHz));
    double difference = 0.0;
    for (std::size_t i = 0; i < found.size(); ++i) {
        EXPECT_NEAR(found[i], wanted[i], 3.5) << "third octave " << i;
        difference += (found[i] - wanted[i]) / static_cast<double>(found.size());
    }
    EXPECT_NEAR(difference, 0.0, 1.5);
}

}  // namespace
}  // namespace haptoflow::cli
