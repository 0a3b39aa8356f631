#include "actuator_identification.hpp"
#include "command_line.hpp"
#include "effects/actuator_profile.hpp"
#include "messages.hpp"
#include "output_file.hpp"
#include "svg_plot.hpp"
#include "texture_distance.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <random>
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
    // Two channels of 32-bit float: the header of a mono file with twice the rate, changed to stereo.
    std::string bytes = read("sweep.wav");
    bytes[22] = 2;
    bytes[32] = 8;
    write("stereo.wav", bytes);
    write("broken.json", "{\"format_version\": 1}");
    const std::string identify = "identify -o profile.json --plot plot.svg ";
    expectRefusals(
        {
            {identify + "missing.wav --sweep sweep.wav", 3, "missing.wav: cannot be read"},
            {identify + "text.wav --sweep sweep.wav", 3, "text.wav: cannot be read"},
            {identify + "recording.wav --sweep recording.wav", 3, "recording.wav: holds no description of its sweep"},
            {identify + "recording.wav --sweep other.wav", 3, "recording.wav: begins 0."},
            {identify + "other.wav --sweep sweep.wav", 3, "other.wav: does not contain the sweep"},
            {identify + "recording.wav --sweep sweep.wav --channel 2", 3, "has no channel 2; it has 1"},
            {identify + "stereo.wav --sweep sweep.wav", 3, "has 2 channels; name the sensor's with --channel"},
            {"show voicecoil", 3, "voicecoil: cannot be opened; expected an actuator profile (JSON), or"},
            {"show broken.json", 3, "broken.json: profile: expected a member \"name\""},
        },
        "actuator ");
}

TEST_F(ActuatorCommandTest, WrongOptionsAreRefusedWithASuggestion) {
    expectRefusals(
        {
            {"swep -o a.wav", 2, "no command 'actuator swep'; did you mean 'sweep'?"},
            {"sweep -o a.wav --second 3", 2, "did you mean '--seconds'?"},
            {"sweep -o a.flac", 2, "did you mean a.wav?"},
            {"sweep -o a.wav --from-hz 900", 2, "less than an octave apart"},
            {"sweep -o a.wav --rate 8000 --to-hz 4000", 2, "too high for --rate 8000"},
            {"sweep -o a.wav --level 2", 2, "from 0.001 to 1"},
            {"show voice-coil --model m.haptoflow", 2, "--labels"},
            {"show voice-coil --boost 40", 2, "from 0 to 24 dB"},
        },
        "actuator ");
    EXPECT_THAT(run("actuator sweep -o a.wav --second 3").errors, Not(HasSubstr("no option '--output'")));
}

TEST_F(ActuatorCommandTest, ShowDescribesAndPlotsTheCompensation) {
    const testing::Finished shown = run("actuator show voice-coil --plot coil.svg");
    ASSERT_EQ(shown.exitCode, 0) << shown.errors;
    EXPECT_THAT(shown.output, AllOf(HasSubstr("voice-coil (approximate)"), HasSubstr("160.0 320.0 Hz"),
                                    HasSubstr("at most +12.0 dB"), HasSubstr("latency"), HasSubstr("together dB")));
    EXPECT_THAT(read("coil.svg"), AllOf(HasSubstr("compensation"), HasSubstr("together"), Not(HasSubstr("nan"))));
    EXPECT_THAT(run("actuator show flat").output, HasSubstr("none: the profile asks for no change"));
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

namespace haptoflow::cli::actuator_identification_test {
namespace {

using ::testing::HasSubstr;

constexpr double twoPi = 2.0 * std::numbers::pi;

/// A second-order bandpass with the peak gain `gain`, at a sample rate.
class Resonance {
public:
    Resonance(double hz, double quality, double gain, double rateHz) : rateHz_(rateHz) {
        const double angle = twoPi * hz / rateHz;
        const double alpha = std::sin(angle) / (2.0 * quality);
        in_ = {gain * alpha / (1.0 + alpha), 0.0, -gain * alpha / (1.0 + alpha)};
        back_ = {-2.0 * std::cos(angle) / (1.0 + alpha), (1.0 - alpha) / (1.0 + alpha)};
    }

    double next(double input) {
        const double output = in_[0] * input + states_[0];
        states_[0] = in_[1] * input - back_[0] * output + states_[1];
        states_[1] = in_[2] * input - back_[1] * output;
        return output;
    }

    [[nodiscard]] std::complex<double> response(double hz) const {
        const std::complex<double> delay = std::polar(1.0, -twoPi * hz / rateHz_);
        return (in_[0] + delay * (in_[1] + delay * in_[2])) / (1.0 + delay * (back_[0] + delay * back_[1]));
    }

private:
    double rateHz_;
    std::array<double, 3> in_{};
    std::array<double, 2> back_{};
    std::array<double, 2> states_{};
};

struct Simulated {
    double rateHz = 48000.0;
    double delaySeconds = 0.25;
    double noise = 0.0;
    double secondOrder = 0.0;
    double thirdOrder = 0.0;
    double gain = 1.0;
    double silenceSeconds = 1.5;
    bool isFlat = false;

    [[nodiscard]] std::vector<Resonance> resonances() const {
        return {
            {160.0, 3.0, 0.6, rateHz}, {320.0, 5.0, 0.5, rateHz}, {90.0, 0.5, 0.1, rateHz}, {900.0, 0.6, 0.1, rateHz}};
    }

    [[nodiscard]] std::complex<double> response(double hz) const {
        if (isFlat) {
            return gain;
        }
        std::complex<double> sum = 0.0;
        for (const Resonance& each : resonances()) {
            sum += each.response(hz);
        }
        return gain * sum;
    }
};

/// The sweep at any time by its definition; independent of ExponentialSweep::samples.
double sweepAt(const ExponentialSweep& sweep, double time) {
    if (time < 0.0 || time > sweep.seconds) {
        return 0.0;
    }
    const double octaves = std::log2(sweep.toHz / sweep.fromHz);
    const double fade = std::min(sweep.seconds * ExponentialSweep::fadeOctaves / octaves, 0.25 * sweep.seconds);
    const double share = std::min({time, sweep.seconds - time, fade}) / fade;
    const double neper = sweep.seconds / std::log(sweep.toHz / sweep.fromHz);
    return sweep.level * std::pow(std::sin(0.5 * std::numbers::pi * share), 2.0) *
           std::sin(twoPi * sweep.fromHz * neper * (std::exp(time / neper) - 1.0));
}

Recording record(const ExponentialSweep& sweep, const Simulated& simulated) {
    std::mt19937 random(3);
    std::normal_distribution<double> normal(0.0, 1.0);
    std::vector<Resonance> resonances = simulated.resonances();
    Recording recording;
    recording.rateHz = simulated.rateHz;
    const double seconds = sweep.seconds + simulated.delaySeconds + simulated.silenceSeconds;
    for (int i = 0; i < static_cast<int>(seconds * simulated.rateHz); ++i) {
        const double played = sweepAt(sweep, i / simulated.rateHz - simulated.delaySeconds) / sweep.level;
        const double driven = sweep.level * (played + simulated.secondOrder * played * played +
                                             simulated.thirdOrder * played * played * played);
        double response = simulated.isFlat ? driven : 0.0;
        if (!simulated.isFlat) {
            for (Resonance& each : resonances) {
                response += each.next(driven);
            }
        }
        recording.samples.push_back(static_cast<float>(simulated.gain * response + simulated.noise * normal(random)));
    }
    return recording;
}

IdentificationSettings named(const std::string& name) {
    return {.name = name, .recordingName = "recording.wav", .mps2PerUnit = {}};
}

Identification identify(const ExponentialSweep& sweep, const Simulated& simulated) {
    return identifyActuator(record(sweep, simulated), sweep, named("simulated"));
}

double peakDecibels(const Simulated& simulated, const effects::ActuatorProfile& profile) {
    double peak = 0.0;
    for (const double hz : profile.frequencyHz) {
        peak = std::max(peak, std::abs(simulated.response(hz)));
    }
    return 20.0 * std::log10(peak);
}

void expectMagnitude(const Identification& found, const Simulated& simulated, double tolerance,
                     const std::string& about) {
    const double peak = peakDecibels(simulated, found.profile);
    EXPECT_LT(found.profile.frequencyHz.front(), 32.0) << about;
    EXPECT_GT(found.profile.frequencyHz.back(), 900.0) << about;
    for (std::size_t i = 0; i < found.profile.frequencyHz.size(); ++i) {
        const double hz = found.profile.frequencyHz[i];
        const double expected = 20.0 * std::log10(std::abs(simulated.response(hz))) - peak;
        EXPECT_NEAR(found.profile.magnitudeDecibels[i], expected, tolerance) << about << ", at " << hz << " Hz";
    }
}

TEST(ActuatorIdentificationTest, TheMagnitudeOfASimulatedActuatorIsFoundWithinADecibelAtEveryRate) {
    const std::vector<std::pair<double, ExponentialSweep>> cases{
        {8000.0, {.seconds = 3.0}},
        {44100.0, {.seconds = 1.5}},
        {48000.0, {.seconds = 3.0, .level = 0.9}},
        {48000.0, {.seconds = 10.0, .fromHz = 15.0, .toHz = 3000.0}},
        {192000.0, {.seconds = 3.0}}};
    for (const auto& [rateHz, sweep] : cases) {
        SCOPED_TRACE(std::to_string(rateHz) + " Hz, " + std::to_string(sweep.seconds) + " s");
        const Simulated simulated{
            .rateHz = rateHz, .delaySeconds = 0.1234567, .noise = 0.0003, .secondOrder = 0.03, .thirdOrder = 0.02};
        const Identification found = identify(sweep, simulated);
        expectMagnitude(found, simulated, 1.5, "");
        EXPECT_EQ(found.profile.measurement->sampleRateHz, rateHz);
        ASSERT_EQ(found.profile.resonancesHz.size(), 2U);
        EXPECT_NEAR(found.profile.resonancesHz[0], 160.0, 8.0);
        EXPECT_NEAR(found.profile.resonancesHz[1], 320.0, 12.0);
        const effects::ActuatorProfile read = effects::ActuatorProfile::parse(found.profile.toJson());
        EXPECT_EQ(read.magnitudeDecibels, found.profile.magnitudeDecibels);
        EXPECT_FALSE(read.isApproximate);
        EXPECT_THAT(read.provenance, HasSubstr("recording.wav"));
    }
}

TEST(ActuatorIdentificationTest, TheDelayIsFoundToAFractionOfAMillisecond) {
    for (const double delay : {0.0, 0.00001, 0.0123457, 0.25, 1.1}) {
        for (const double rateHz : {8000.0, 48000.0}) {
            const Identification found = identify({.seconds = 4.0}, {.rateHz = rateHz, .delaySeconds = delay});
            EXPECT_NEAR(found.profile.measurement->delaySeconds, delay, 3e-4) << delay << " s at " << rateHz;
        }
    }
}

TEST(ActuatorIdentificationTest, ThePhaseIsTheActuatorsOwnWithoutTheDelay) {
    // The unmeasured response outside the range makes the delay uncertain by this much.
    constexpr double unknownDelaySeconds = 1e-4;
    for (const double gain : {1.0, -1.0}) {
        const Simulated simulated{.delaySeconds = 0.2003, .gain = gain};
        const Identification found = identify({.seconds = 4.0}, simulated);
        for (std::size_t i = 0; i < found.profile.frequencyHz.size(); ++i) {
            const double hz = found.profile.frequencyHz[i];
            if (hz > 40.0 && hz < 700.0) {
                const double expected = std::arg(simulated.response(hz)) * 360.0 / twoPi;
                EXPECT_NEAR(std::remainder(found.profile.phaseDegrees[i] - expected, 360.0), 0.0,
                            5.0 + 360.0 * hz * unknownDelaySeconds)
                    << gain << ", at " << hz << " Hz";
            }
        }
    }
}

TEST(ActuatorIdentificationTest, HarmonicDistortionIsMeasuredAndExcludedFromTheMagnitude) {
    // For a sine, x^2 has a second harmonic of a half; x^3 a third harmonic of a quarter and a fundamental of three
    // quarters.
    for (const auto& [second, third] : {std::pair{0.1, 0.0}, {0.0, 0.1}, {0.2, 0.1}, {0.01, 0.0}}) {
        const Simulated simulated{.secondOrder = second, .thirdOrder = third, .isFlat = true};
        const Identification found = identify({.seconds = 5.0}, simulated);
        const double fundamental = 1.0 + 0.75 * third;
        const double expected = 100.0 * std::hypot(0.5 * second, 0.25 * third) / fundamental;
        // The third harmonic is within the sweep's range for fewer fundamentals than the second.
        EXPECT_NEAR(found.profile.measurement->distortionPercent, expected, 0.12 * expected) << second << ", " << third;
        expectMagnitude(found, simulated, 0.5, "distortion");
    }
    EXPECT_LT(identify({}, {.isFlat = true}).profile.measurement->distortionPercent, 0.05);
}

TEST(ActuatorIdentificationTest, NoiseChangesTheMagnitudeByLessThanADecibelWhereTheActuatorExceedsIt) {
    const Simulated simulated{.noise = 0.02};
    const Identification found = identify({.seconds = 10.0}, simulated);
    const double peak = peakDecibels(simulated, found.profile);
    int compared = 0;
    for (std::size_t i = 0; i < found.profile.frequencyHz.size(); ++i) {
        if (found.profile.magnitudeDecibels[i] - found.noiseDecibels[i] > 25.0) {
            const double expected = 20.0 * std::log10(std::abs(simulated.response(found.profile.frequencyHz[i])));
            EXPECT_NEAR(found.profile.magnitudeDecibels[i], expected - peak, 1.0) << found.profile.frequencyHz[i];
            ++compared;
        }
    }
    EXPECT_GT(compared, 40);
    EXPECT_LT(found.profile.measurement->signalToNoiseDecibels, 45.0);
    EXPECT_GT(identify({.seconds = 10.0}, {}).profile.measurement->signalToNoiseDecibels, 60.0);
}

TEST(ActuatorIdentificationTest, ACalibratedSensorGivesTheRatedLevel) {
    const ExponentialSweep sweep{.seconds = 4.0};
    IdentificationSettings settings = named("calibrated");
    const Recording recording = record(sweep, {.gain = 0.5, .isFlat = true});
    EXPECT_FALSE(identifyActuator(recording, sweep, settings).profile.ratedLevelMps2.has_value());
    settings.mps2PerUnit = 100.0;
    EXPECT_NEAR(*identifyActuator(recording, sweep, settings).profile.ratedLevelMps2, 50.0, 1.0);
}

std::string refusalOf(const Recording& recording, const ExponentialSweep& sweep) {
    try {
        (void)identifyActuator(recording, sweep, named("refused"));
    } catch (const InputError& error) {
        EXPECT_THAT(error.what(), ::testing::StartsWith("recording.wav: "));
        return error.what();
    }
    return "not refused";
}

TEST(ActuatorIdentificationTest, TheErrorForAShortRecordingStatesTheMissingTime) {
    const ExponentialSweep sweep{.seconds = 4.0};
    Recording recording = record(sweep, {.noise = 0.001});
    const auto secondsLeft = [&](double seconds) {
        Recording cut = recording;
        cut.samples.resize(static_cast<std::size_t>(seconds * cut.rateHz));
        return cut;
    };
    EXPECT_THAT(refusalOf(secondsLeft(2.0), sweep), HasSubstr("lasts 2.0 s, but the sweep alone lasts 4.0 s"));
    EXPECT_THAT(refusalOf(secondsLeft(4.1), sweep), HasSubstr("is too short, it ends"));
    EXPECT_THAT(refusalOf(secondsLeft(4.3), sweep), HasSubstr("record until 1 s of silence"));
    EXPECT_THAT(refusalOf(secondsLeft(0.0), sweep), HasSubstr("lasts 0.0 s"));
    EXPECT_EQ(refusalOf(secondsLeft(4.9), sweep), "not refused");
    recording.samples.erase(recording.samples.begin(), recording.samples.begin() + 48000);
    EXPECT_THAT(refusalOf(recording, sweep), HasSubstr("after the sweep has begun; start recording first"));
}

TEST(ActuatorIdentificationTest, ASilentOrClippedRecordingIsRefused) {
    const ExponentialSweep sweep{.seconds = 4.0};
    Recording silent = record(sweep, {.gain = 1e-5});
    EXPECT_THAT(refusalOf(silent, sweep), HasSubstr("is silent"));
    silent.samples.assign(silent.samples.size(), 0.0F);
    EXPECT_THAT(refusalOf(silent, sweep), HasSubstr("is silent"));
    Recording clipped = record(sweep, {.gain = 12.0});
    std::ranges::for_each(clipped.samples, [](float& sample) { sample = std::clamp(sample, -1.0F, 1.0F); });
    EXPECT_THAT(refusalOf(clipped, sweep), HasSubstr("is clipped"));
}

TEST(ActuatorIdentificationTest, ARecordingWithoutTheSweepIsRefused) {
    const ExponentialSweep sweep{.seconds = 4.0};
    Recording recording = record(sweep, {.noise = 0.05, .gain = 1e-6});
    EXPECT_THAT(refusalOf(recording, sweep), HasSubstr("does not contain the sweep"));
    const Recording other = record({.seconds = 5.0}, {});
    EXPECT_THAT(refusalOf(other, sweep), HasSubstr("does not contain the sweep"));
    const Recording elsewhere = record({.seconds = 4.0, .fromHz = 40.0, .toHz = 600.0}, {});
    EXPECT_THAT(refusalOf(elsewhere, sweep), HasSubstr("does not contain the sweep"));
    std::mt19937 random(1);
    for (std::size_t i = 0; i < recording.samples.size(); ++i) {
        recording.samples[i] = 0.5F * static_cast<float>(std::sin(twoPi * 100.0 * static_cast<double>(i) / 48000.0));
    }
    EXPECT_NE(refusalOf(recording, sweep), "not refused") << "a tone";
    Recording slow = record({.seconds = 4.0}, {.rateHz = 48000.0});
    slow.rateHz = 44100.0;
    EXPECT_THAT(refusalOf(slow, sweep), HasSubstr("at the rate that it states"));
    EXPECT_NE(refusalOf(record({.seconds = 2.0, .level = 0.05}, {.noise = 0.06}), {.seconds = 2.0, .level = 0.05}),
              "not refused");
    const ExponentialSweep high{.seconds = 4.0, .toHz = 5000.0};
    EXPECT_THAT(refusalOf(record(high, {.rateHz = 8000.0}), high), HasSubstr("too low for a sweep to 5000 Hz"));
}

TEST(ExponentialSweepTest, ItsSamplesFollowTheDefinitionAtEveryRate) {
    const ExponentialSweep sweep{.seconds = 3.0, .fromHz = 20.0, .toHz = 1200.0, .level = 0.5};
    for (const double rateHz : {8000.0, 44100.0, 192000.0}) {
        const std::vector<float> samples = sweep.samples(rateHz);
        ASSERT_EQ(samples.size(), static_cast<std::size_t>(3.0 * rateHz));
        for (std::size_t i = 0; i < samples.size(); i += 7) {
            ASSERT_NEAR(samples[i], sweepAt(sweep, static_cast<double>(i) / rateHz), 1e-6) << rateHz << ", " << i;
        }
        EXPECT_EQ(samples.front(), 0.0F);
        EXPECT_LT(std::abs(samples.back()), 1e-3F);
    }
}

TEST(ExponentialSweepTest, ItsDescriptionIsReadBackAndOtherTextIsRefused) {
    const ExponentialSweep sweep{.seconds = 3.5, .fromHz = 21.25, .toHz = 1000.0, .level = 0.1};
    const auto read = ExponentialSweep::parse(sweep.describe());
    ASSERT_TRUE(read.has_value());
    EXPECT_EQ(read->seconds, 3.5);
    EXPECT_EQ(read->fromHz, 21.25);
    EXPECT_EQ(read->toHz, 1000.0);
    EXPECT_EQ(read->level, 0.1);
    for (const char* text :
         {"", "a song", "haptoflow sweep:", "haptoflow sweep: seconds=nan from_hz=20 to_hz=1200 level=0.1",
          "haptoflow sweep: seconds=1e9 from_hz=20 to_hz=1200 level=0.1",
          "haptoflow sweep: seconds=10 from_hz=1200 to_hz=20 level=0.1",
          "haptoflow sweep: seconds=10 from_hz=20 to_hz=1200 level=0",
          "haptoflow sweep: seconds=10 from_hz=-20 to_hz=1200 level=1"}) {
        EXPECT_FALSE(ExponentialSweep::parse(text).has_value()) << text;
    }
}

}  // namespace
}  // namespace haptoflow::cli::actuator_identification_test
