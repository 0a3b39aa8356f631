#include "command_line.hpp"
#include "effects/actuator_profile.hpp"
#include "output_file.hpp"
#include "svg_plot.hpp"
#include "texture_distance.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

namespace haptoflow::cli::actuator_command_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

class ActuatorCommandTest : public testing::CommandLineTest {
protected:
    /// Writes the sweep at half the level and 0.1 s later.
    void writeRecording(const std::string& name, int rateHz = 48000) const {
        const Recording sweep = readRecording("the wave", at("sweep.wav").string());
        std::vector<float> samples(static_cast<std::size_t>(sweep.rateHz / 10.0));
        for (const float sample : sweep.samples) {
            samples.push_back(0.5F * sample);
        }
        WavWriter writer(at(name), rateHz, name);
        writer.write(samples);
        writer.close();
    }
};

TEST_F(ActuatorCommandTest, ASweepOverADirectWireGivesAFlatProfileAndAPlot) {
    const testing::Finished sweep = run("actuator sweep -o sweep.wav --seconds 3 --level 0.5");
    ASSERT_EQ(sweep.exitCode, 0) << sweep.errors;
    const Recording written = readRecording("the wave", at("sweep.wav").string());
    EXPECT_EQ(written.rateHz, 48000.0);
    EXPECT_EQ(written.samples.size(), 4U * 48000U);
    EXPECT_NEAR(std::ranges::max(written.samples), 0.5, 1e-3);
    EXPECT_TRUE(
        std::all_of(written.samples.end() - 48000, written.samples.end(), [](float each) { return each == 0.0F; }));

    writeRecording("recording.wav");
    const testing::Finished identified = run(
        "actuator identify recording.wav --sweep sweep.wav -o wire.json --plot wire.svg --mps2-per-unit 100 --name 'a "
        "wire'");
    ASSERT_EQ(identified.exitCode, 0) << identified.errors;
    EXPECT_THAT(identified.output, AllOf(HasSubstr("a wire\n"), HasSubstr("measurement   delay ")));
    const auto profile = effects::ActuatorProfile::parse(read("wire.json"));
    EXPECT_EQ(profile.name, "a wire");
    EXPECT_NEAR(*profile.ratedLevelMps2, 50.0, 0.5);
    EXPECT_NEAR(profile.measurement->delaySeconds, 0.1, 3e-4);
    for (std::size_t i = 0; i < profile.frequencyHz.size(); ++i) {
        EXPECT_NEAR(profile.magnitudeDecibels[i], 0.0, 1.0) << profile.frequencyHz[i];
    }
    EXPECT_THAT(read("wire.svg"), AllOf(StartsWith("<svg "), HasSubstr(">Hz<"), HasSubstr(">dB<"), HasSubstr(">100<"),
                                        HasSubstr("a wire: measured response"), HasSubstr("</svg>")));

    const testing::Finished shown = run("actuator show wire.json");
    EXPECT_EQ(shown.exitCode, 0) << shown.errors;
    EXPECT_THAT(shown.output, AllOf(HasSubstr("a wire"), HasSubstr("rated level   ")));
}

TEST_F(ActuatorCommandTest, WrongInputFilesAreNamedWithTheReasonAndNoOutputRemains) {
    ASSERT_EQ(run("actuator sweep -o sweep.wav --seconds 2").exitCode, 0);
    ASSERT_EQ(run("actuator sweep -o other.wav --seconds 3").exitCode, 0);
    writeRecording("recording.wav");
    write("text.wav", "not a sound");
    const std::size_t files = fileCount();
    const auto complaintOf = [this](const std::string& words) {
        const testing::Finished finished = run("actuator identify " + words + " -o profile.json --plot plot.svg");
        EXPECT_EQ(finished.exitCode, 3) << words << finished.errors;
        return finished.errors;
    };
    EXPECT_THAT(complaintOf("missing.wav --sweep sweep.wav"), HasSubstr("missing.wav: cannot be read"));
    EXPECT_THAT(complaintOf("text.wav --sweep sweep.wav"), HasSubstr("text.wav: cannot be read"));
    EXPECT_THAT(complaintOf("recording.wav --sweep recording.wav"),
                HasSubstr("recording.wav: holds no description of its sweep"));
    EXPECT_THAT(complaintOf("recording.wav --sweep other.wav"), HasSubstr("recording.wav: begins 0."));
    EXPECT_THAT(complaintOf("other.wav --sweep sweep.wav"), HasSubstr("other.wav: does not contain the sweep"));
    EXPECT_THAT(complaintOf("recording.wav --sweep sweep.wav --channel 2"), HasSubstr("has no channel 2; it has 1"));
    EXPECT_EQ(fileCount(), files);
}

TEST_F(ActuatorCommandTest, WrongOptionsAreRefusedWithASuggestion) {
    ASSERT_EQ(run("actuator sweep -o sweep.wav --seconds 1").exitCode, 0);
    const auto complaintOf = [this](const std::string& words) {
        const testing::Finished finished = run("actuator " + words);
        EXPECT_EQ(finished.exitCode, 2) << words << finished.errors;
        return finished.errors;
    };
    EXPECT_THAT(complaintOf("swep -o a.wav"), HasSubstr("no command 'actuator swep'; did you mean 'sweep'?"));
    EXPECT_THAT(complaintOf("sweep -o a.wav --second 3"), HasSubstr("did you mean '--seconds'?"));
    EXPECT_THAT(complaintOf("sweep -o a.wav --second 3"), Not(HasSubstr("no option '--output'")));
    EXPECT_THAT(complaintOf("sweep -o a.flac"), HasSubstr("did you mean a.wav?"));
    EXPECT_THAT(complaintOf("sweep -o a.wav --from-hz 900"), HasSubstr("less than an octave apart"));
    EXPECT_THAT(complaintOf("sweep -o a.wav --rate 8000 --to-hz 4000"), HasSubstr("too high for --rate 8000"));
    EXPECT_THAT(complaintOf("sweep -o a.wav --level 2"), HasSubstr("from 0.001 to 1"));
    EXPECT_THAT(complaintOf("identify sweep.wav --sweep sweep.wav -o sweep.wav"), HasSubstr("is the same file as"));
    EXPECT_THAT(complaintOf("show voice-coil --model m.haptoflow"), HasSubstr("--labels"));
    EXPECT_THAT(complaintOf("show voice-coil --boost 40"), HasSubstr("from 0 to 24 dB"));
    EXPECT_FALSE(exists("a.wav"));
}

TEST_F(ActuatorCommandTest, TheChannelOfARecordingWithSeveralMustBeNamed) {
    ASSERT_EQ(run("actuator sweep -o sweep.wav --seconds 1").exitCode, 0);
    // Two channels of 32-bit float: the header of a mono file with twice the rate, changed to stereo.
    std::string bytes = read("sweep.wav");
    bytes[22] = 2;
    bytes[32] = 8;
    write("stereo.wav", bytes);
    const testing::Finished finished = run("actuator identify stereo.wav --sweep sweep.wav -o profile.json");
    EXPECT_EQ(finished.exitCode, 3);
    EXPECT_THAT(finished.errors, HasSubstr("has 2 channels; name the sensor's with --channel"));
}

TEST_F(ActuatorCommandTest, ShowDescribesAndPlotsTheCompensation) {
    const testing::Finished shown = run("actuator show voice-coil --plot coil.svg");
    ASSERT_EQ(shown.exitCode, 0) << shown.errors;
    EXPECT_THAT(shown.output, AllOf(HasSubstr("voice-coil (approximate)"), HasSubstr("160.0 320.0 Hz"),
                                    HasSubstr("at most +12.0 dB"), HasSubstr("latency"), HasSubstr("together dB")));
    EXPECT_THAT(read("coil.svg"), AllOf(HasSubstr("compensation"), HasSubstr("together"), Not(HasSubstr("nan"))));
    EXPECT_THAT(run("actuator show flat").output, HasSubstr("none: the profile asks for no change"));
    const testing::Finished missing = run("actuator show voicecoil");
    EXPECT_EQ(missing.exitCode, 3);
    EXPECT_THAT(missing.errors, HasSubstr("voicecoil: cannot be opened; expected an actuator profile (JSON), or"));
    write("broken.json", "{\"format_version\": 1}");
    const testing::Finished broken = run("actuator show broken.json");
    EXPECT_EQ(broken.exitCode, 3);
    EXPECT_THAT(broken.errors, HasSubstr("broken.json: profile: expected a member \"name\""));
}

TEST(TextureDistanceTest, CompensationReducesTheDistanceOfEveryLabelOfTheShippedModel) {
    const model::ModelFile model = model::ModelFile::read(HAPTOFLOW_TEST_DEFAULT_MODEL);
    const std::vector<TextureDistance> distances =
        textureDistances(model, *effects::ActuatorProfile::builtIn("voice-coil"), {});
    EXPECT_EQ(distances.size(), model.header().labels.size());
    for (const TextureDistance& each : distances) {
        EXPECT_GT(each.uncompensatedDecibels, 2.0) << each.label;
        EXPECT_LT(each.compensatedDecibels, 0.6 * each.uncompensatedDecibels) << each.label;
    }
}

TEST(SvgPlotTest, NamesAreEscapedAndValuesThatAreNotFiniteAreSkipped) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const std::string drawn = svgPlot("<&\"", {20.0, 100.0, 500.0, 1000.0},
                                      {{.axis = "dB",
                                        .lowest = -20.0,
                                        .highest = 0.0,
                                        .tick = 10.0,
                                        .lines = {{"a<b", "#000", {0.0, nan, -1e300, -10.0}, false}}}});
    EXPECT_THAT(drawn, AllOf(HasSubstr("&lt;&amp;&quot;"), HasSubstr("a&lt;b"), Not(HasSubstr("nan")),
                             Not(HasSubstr("inf")), Not(HasSubstr("e+"))));
}

}  // namespace
}  // namespace haptoflow::cli::actuator_command_test
