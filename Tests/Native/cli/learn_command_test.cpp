// `haptoflow learn`: recordings of every format become material files that render uses.
#include "command_line.hpp"
#include "learn_output.hpp"
#include "made_files.hpp"

#include "learning/texture_figures.hpp"
#include "model/material_file.hpp"
#include "model/model_file.hpp"
#include "output_file.hpp"
#include "recordings/prepared_recording.hpp"
#include "recordings/recording_reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace haptoflow::cli {
namespace {

using learning::testing::MadeRecording;
using learning::testing::MadeSurface;
using testing::Finished;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::tableOf;
using testing::writeWav;

class LearnCommandTest : public testing::CommandLineTest {
protected:
    /// Learns with the tiny model, whose networks are fast.
    [[nodiscard]] Finished learn(const std::string& words) const {
        return run("learn " + words + " --model '" + testing::tinyModel + "'");
    }

    void expectRefused(const std::string& words, const std::string& said, int exitCode = 3) const {
        const std::string command = "learn " + words + " -o refused.haptomaterial --model '" + testing::tinyModel + "'";
        expectRefusals({{command, exitCode, said}});
    }

    const MadeRecording made_{{}, {}};
    const std::string csv_ = tableOf(made_);
};

TEST_F(LearnCommandTest, ATableGivesMaterialReportAndPictureWithEqualBytesEachTime) {
    write("denim.csv", csv_);
    const Finished first =
        learn("denim.csv --report denim.report.json --picture denim.svg --licence 'CC BY 4.0' --category fabric");
    ASSERT_EQ(first.exitCode, 0) << first.errors;
    for (const char* words : {"Learnt denim from 10.0 s of sliding", "nearest label",
                              "none found, so nothing was removed", "to gain most       record more of the same"}) {
        EXPECT_THAT(first.output, HasSubstr(words));
    }
    const model::MaterialFile material = model::readMaterial(at("denim.haptomaterial"));
    EXPECT_EQ(material.label.name, "denim");
    EXPECT_EQ(material.label.category, "fabric");
    EXPECT_EQ(material.provenance.licence, "CC BY 4.0");
    EXPECT_EQ(material.provenance.recordings, "denim.csv");

    const nlohmann::json report = nlohmann::json::parse(read("denim.report.json"));
    const nlohmann::json& spectra = report["spectra"];
    ASSERT_GE(spectra["speeds"].size(), 3U);
    for (const nlohmann::json& each : spectra["speeds"]) {
        for (const char* curve : {"recorded", "learnt", "nearest_label"}) {
            EXPECT_EQ(each[curve]["decibels"].size(), spectra["frequencies_hz"].size());
        }
        EXPECT_NEAR(each["learnt"]["rms_mps2"].get<double>() / each["recorded"]["rms_mps2"].get<double>(), 1.0, 0.2);
    }
    for (const nlohmann::json& force : report["levels"]["forces"]) {
        EXPECT_EQ(force["learnt_mps2"].size(), report["levels"]["speeds_mps"].size());
        EXPECT_TRUE(force["speeds"][0]["recorded"]["ribs_db"][0].is_null()) << "no ribs were found";
    }
    const std::string picture = read("denim.svg");
    for (const std::string& words :
         {std::string("recorded 31 to "), std::string("extrapolated"), std::string("kurtosis"),
          "nearest label, " + report["nearest_label"].get<std::string>()}) {
        EXPECT_THAT(picture, HasSubstr(words));
    }
    EXPECT_THAT(picture, Not(HasSubstr("ribs"))) << "no ribs were found";
    const std::string before = read("denim.haptomaterial");
    ASSERT_EQ(learn("denim.csv --licence 'CC BY 4.0' --category fabric --quiet").exitCode, 0);
    EXPECT_EQ(read("denim.haptomaterial"), before);
}

TEST_F(LearnCommandTest, TheSensorsNoiseTheDistanceOfRibsAndTheAngleOfTheMaterialAreTold) {
    MadeRecording ribbed({.ribs = {0.8, 0.45}, .ribShare = 0.5}, {});
    write("ribbed.csv", tableOf(learning::testing::noisy(ribbed)));
    const Finished finished = learn("ribbed.csv --report ribbed.report.json --quiet");
    ASSERT_EQ(finished.exitCode, 0) << finished.errors;
    EXPECT_THAT(finished.output, HasSubstr("m/s^2 RMS, removed; found where the tip rests"));
    EXPECT_THAT(finished.output, HasSubstr("every 1.09 mm; the material's first axis lies across them, 29 degrees from "
                                           "the recording's"));
    EXPECT_NEAR(nlohmann::json::parse(read("ribbed.report.json"))["turn_degrees"].get<double>(), 29.36, 1.0);
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
    write("tile.csv", tableOf(MadeRecording(surface, {.seconds = 12.0})));
    const Finished learnt = run("learn tile.csv --quiet");
    ASSERT_EQ(learnt.exitCode, 0) << learnt.errors;

    write("scene.json", R"({"surfaces": [{"name": "floor", "shape": {"plane": {}}, "material": "tile"}]})");
    write("stroke.csv", "t,x,y,z,force\n0,0,0.0005,0,0.8\n6,0.54,0.0005,0,0.8\n");
    const Finished rendered =
        run("render scene.json --stroke stroke.csv --material tile.haptomaterial -o tile.wav "
            "--rate 8000 --quiet");
    ASSERT_EQ(rendered.exitCode, 0) << rendered.errors;

    // The reference: the same surface at 90 mm/s; only its force varies by half.
    const MadeRecording truth(surface, {.seconds = 12.0, .minimumSpeedMps = 0.09, .maximumSpeedMps = 0.09},
                              testing::recordingHz, 99);
    std::vector<float> heard = readRecording("the wave", at("tile.wav").string()).samples;
    std::ranges::transform(heard, heard.begin(), [](float value) { return 200.0F * value; });
    const std::vector<double> found = bandsOf(middleAt2kHz(heard, 8000.0));
    const std::vector<double> wanted = bandsOf(middleAt2kHz(truth.acceleration, testing::recordingHz));
    double difference = 0.0;
    for (std::size_t i = 0; i < found.size(); ++i) {
        EXPECT_NEAR(found[i], wanted[i], 3.5) << "third octave " << i;
        difference += (found[i] - wanted[i]) / static_cast<double>(found.size());
    }
    EXPECT_NEAR(difference, 0.0, 1.5);
}

TEST_F(LearnCommandTest, TheSidecarOfAWavScalesAndNamesIt) {
    writeWav(at("mat.wav"), made_, 50.0F);
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

TEST_F(LearnCommandTest, ErrorsNameTheFileTheColumnAndTheOptionThatHelps) {
    write("b.csv", tableOf(made_, "time_s,acceleration_mps2,a,b,force_newtons"));
    expectRefused("b.csv", "b.csv: no motion in it or beside it; expected columns velocity_x_mps, velocity_y_mps | ");
    write("c.csv", tableOf(made_, "time_s,acceleration_mps2,velocity_x_mps,velocity_y_mps,c"));
    expectRefused("c.csv", "or --force-newtons");
    write("l.csv", tableOf(MadeRecording({}, {.seconds = 1.5})));
    expectRefused("l.csv", "l.csv: the recording lasts 1.5 s; record 10 s or more of sliding");
    write("n.wav", "no sound");
    expectRefused("n.wav --full-scale-mps2 50", "n.wav: not a RIFF WAVE file");
}

TEST_F(LearnCommandTest, TheCommandLineSaysWhatTheForceMeans) {
    write("true.csv", csv_);
    ASSERT_EQ(learn("true.csv -o true.haptomaterial").exitCode, 0);
    MadeRecording changed = made_;
    std::ranges::transform(changed.force, changed.force.begin(), [](float force) { return -force - 0.75F; });
    write("turned.csv", tableOf(changed));
    expectRefused("turned.csv", "give the key \"force_sign\": -1 in turned.json or --force-sign -1");
    expectRefused("turned.csv --force-sign 2", "--force-sign", 2);
    EXPECT_EQ(
        learn("turned.csv --force-sign -1 --force-rest-newtons -0.75 --name true -o turned.haptomaterial").exitCode, 0);
    const auto laws = [&](const std::string& name) {
        return nlohmann::json::parse(read(name)).at("level_exponents").dump();
    };
    EXPECT_EQ(laws("turned.haptomaterial"), laws("true.haptomaterial"));
}

TEST_F(LearnCommandTest, OptionsThatContradictTheFileAreUsageErrors) {
    write("denim.csv", csv_);
    expectRefused("denim.csv --speed-mps 0.1", "--speed-mps: denim.csv has a motion of its own", 2);
    expectRefused("denim.csv --force-newtons 1", "--force-newtons: denim.csv has a force of its own", 2);
    expectRefused("denim.csv --full-scale-mps2 10", "--full-scale-mps2 is for WAV", 2);
    expectRefused("denim.csv --name Denim", "--name 'Denim': expected 1 to 128 characters without capital letters", 2);
}

TEST_F(LearnCommandTest, ALabelInASidecarNamesTheMaterialAndNeverAFile) {
    std::filesystem::create_directories(at("work"));
    std::filesystem::create_directories(at("victim"));
    write("victim/wood.haptomaterial", "mine");
    write("work/wood.haptomaterial", "mine, too");
    write("work/denim.csv", csv_);
    for (const std::string& label : {at("victim/wood").string(), std::string("wood"), std::string("../victim/wood")}) {
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
    write("in/felt.csv", tableOf(made_, "time_s,acceleration_mps2,a,b,c"));
    for (const std::string& name :
         {at("secret.csv").string(), std::string("link.csv"), std::string("x/../../secret.csv")}) {
        write("in/felt.json", nlohmann::json({{"motion", name}}).dump());
        expectRefused("in/felt.csv", "in/felt.json: key 'motion' names " + name + ", which is outside the folder");
    }
    write("in/felt.json", R"({"motion": "../in/./near.csv"})");
    recordings::DiskFiles files;
    EXPECT_FALSE(recordings::readMaterialRecording(files, at("in/felt.csv"), {}).velocityMps.empty());
}

TEST_F(LearnCommandTest, TextsThatAMaterialFileMayNotHoldAreRefusedBeforeTheFit) {
    write("denim.csv", csv_);
    const std::string expected = "expected one line of text in UTF-8, without control characters";
    expectRefused("denim.csv --category \"$(printf 'a\\tb')\"", "--category 'a\\x09b'", 2);
    expectRefused("denim.csv --licence \"$(printf 'CC\\nBY')\"", "--licence 'CC\\x0ABY': " + expected, 2);
    expectRefused("denim.csv --licence " + std::string(5000, 'a'), "4096 bytes at most", 2);
    expectRefused("denim.csv --category " + std::string(200, 'a'), "128 bytes at most", 2);
    expectRefused("denim.csv --name ' '", "not all blank", 2);
    expectRefused("denim.csv --name \"$(printf 'a\\tb')\"", "--name 'a\\x09b'", 2);
    for (const std::string key : {"licence", "source", "label"}) {
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

}  // namespace
}  // namespace haptoflow::cli
