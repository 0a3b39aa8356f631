#include "actuator_identification.hpp"
#include "commands.hpp"
#include "effects/actuator_profile.hpp"
#include "effects/compensation.hpp"
#include "exponential_sweep.hpp"
#include "headless/command_files.hpp"
#include "messages.hpp"
#include "model/plain_text.hpp"
#include "option_values.hpp"
#include "output_file.hpp"
#include "svg_plot.hpp"
#include "texture_distance.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iomanip>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace haptoflow::cli {
namespace {

using effects::ActuatorProfile;

constexpr const char* actuatorColour = "#c2410c";
constexpr const char* compensationColour = "#1d4ed8";
constexpr const char* togetherColour = "#15803d";
constexpr const char* quietColour = "#888";

struct SweepOptions {
    std::string outputPath;
    std::uint32_t rateHz = 48000;
    ExponentialSweep sweep;
};

struct IdentifyOptions {
    std::string recordingPath;
    std::string sweepPath;
    std::string outputPath;
    std::string plotPath;
    std::string name;
    int channel = 0;
    std::optional<double> mps2PerUnit;
};

struct ShowOptions {
    std::string profile;
    std::string plotPath;
    std::string modelPath;
    bool labels = false;
    effects::CompensationSettings compensation;
};

void runSweep(const SweepOptions& options) {
    requireWavName("-o", options.outputPath);
    const ExponentialSweep& sweep = options.sweep;
    if (!(sweep.toHz >= 2.0 * sweep.fromHz)) {
        throw UsageError("--from-hz and --to-hz are less than an octave apart; the sweep rises from one to the other");
    }
    if (sweep.toHz > 0.45 * options.rateHz) {
        throw UsageError("--to-hz " + fixedDecimals(sweep.toHz, 0) + " is too high for --rate " +
                         std::to_string(options.rateHz) + "; at most " + fixedDecimals(0.45 * options.rateHz, 0) +
                         " Hz");
    }
    OutputFile file("-o", options.outputPath);
    WavWriter writer(file.partial(), static_cast<int>(options.rateHz), options.outputPath, sweep.describe());
    writer.write(sweep.samples(options.rateHz));
    writer.write(std::vector<float>(
        static_cast<std::size_t>(ExponentialSweep::silenceSeconds * static_cast<double>(options.rateHz))));
    writer.close();
    file.commit();
}

ExponentialSweep readSweep(const std::string& path) {
    const std::optional<ExponentialSweep> sweep = ExponentialSweep::parse(readRecording("--sweep", path).comment);
    if (!sweep) {
        throw InputError(
            path +
            ": holds no description of its sweep; expected the file that `haptoflow actuator sweep` wrote, "
            "not converted by another program");
    }
    return *sweep;
}

/// A panel whose decibel axis covers all finite values of the lines, with its tick distance.
PlotPanel decibelPanel(std::vector<PlotLine> lines, double minimumShown) {
    PlotPanel panel{.axis = "dB", .lowest = 0.0, .highest = 0.0, .tick = 10.0, .lines = std::move(lines)};
    for (const PlotLine& line : panel.lines) {
        for (const double value : line.values) {
            if (std::isfinite(value)) {
                panel.lowest = std::min(panel.lowest, value);
                panel.highest = std::max(panel.highest, value);
            }
        }
    }
    panel.lowest = std::max(std::floor(panel.lowest / 10.0) * 10.0, minimumShown);
    panel.highest = std::ceil((panel.highest + 1.0) / 10.0) * 10.0;
    return panel;
}

std::string plotOf(const Identification& found) {
    const ActuatorProfile& profile = found.profile;
    const PlotPanel magnitude = decibelPanel({{"actuator", actuatorColour, profile.magnitudeDecibels},
                                              {"harmonics 2 to 5", compensationColour, found.distortionDecibels, true},
                                              {"noise", quietColour, found.noiseDecibels, true}},
                                             -100.0);
    const PlotPanel phase{
        .axis = "phase, degrees",
        .lowest = -180.0,
        .highest = 180.0,
        .tick = 90.0,
        .lines = {{"phase behind a delay of " + fixedDecimals(profile.measurement->delaySeconds * 1000.0, 2) + " ms",
                   actuatorColour, profile.phaseDegrees}}};
    return svgPlot(profile.name + ": measured response", profile.frequencyHz, {magnitude, phase});
}

void describe(const ActuatorProfile& profile) {
    resultStream() << model::printable(profile.name) << (profile.isApproximate ? " (approximate)" : "") << '\n'
                   << model::printable(profile.provenance) << '\n';
    resultStream() << "  range         " << fixedDecimals(profile.frequencyHz.front(), 1) << " to "
                   << fixedDecimals(profile.frequencyHz.back(), 1) << " Hz, " << profile.frequencyHz.size() << " points"
                   << (profile.phaseDegrees.empty() ? ", no phase" : "") << '\n';
    resultStream() << "  resonances   ";
    for (const double hz : profile.resonancesHz) {
        resultStream() << ' ' << fixedDecimals(hz, 1);
    }
    resultStream() << (profile.resonancesHz.empty() ? " none" : " Hz") << '\n';
    resultStream() << "  rated level   "
                   << (profile.ratedLevelMps2
                           ? fixedDecimals(*profile.ratedLevelMps2, 2) + " m/s^2 at 0 dB for an output of 1"
                           : "unknown")
                   << '\n';
    if (profile.measurement) {
        const effects::ActuatorMeasurement& measured = *profile.measurement;
        resultStream() << "  measurement   delay " << fixedDecimals(measured.delaySeconds * 1000.0, 2)
                       << " ms, distortion " << fixedDecimals(measured.distortionPercent, 2) << " %, signal to noise "
                       << fixedDecimals(measured.signalToNoiseDecibels, 1) << " dB, at "
                       << fixedDecimals(measured.sampleRateHz, 0) << " Hz\n";
    }
}

void runIdentify(const IdentifyOptions& options) {
    const ExponentialSweep sweep = readSweep(options.sweepPath);
    const Recording recording = readRecording("the recording", options.recordingPath, options.channel);
    OutputFile file("-o", options.outputPath);
    const OptionalOutput plot = optionalOutput("--plot", options.plotPath);
    // Paths may hold bytes that a profile may not.
    constexpr std::size_t maximumNameBytes = 128;
    constexpr std::size_t maximumPathBytes = 2048;
    const std::string stem = model::printable(std::filesystem::path(options.outputPath).stem().string());
    const std::string recordingName = model::printable(options.recordingPath);
    const Identification found = identifyActuator(
        recording, sweep,
        {.name = options.name.empty() ? std::string(model::shortened(stem, maximumNameBytes)) : options.name,
         .recordingName = std::string(model::shortened(recordingName, maximumPathBytes)),
         .mps2PerUnit = options.mps2PerUnit});
    const std::string profile = found.profile.toJson();
    (void)ActuatorProfile::parse(profile);
    writeText(file, profile);
    writeText(plot, plotOf(found));
    file.commit();
    commit(plot);
    describe(found.profile);
    constexpr double noticeablePercent = 10.0;
    if (found.profile.measurement->distortionPercent > noticeablePercent) {
        note(options.recordingPath + ": the actuator distorts by " +
             fixedDecimals(found.profile.measurement->distortionPercent, 0) +
             " %; a quieter sweep (--level) measures it at the levels of textures.");
    }
}

void describeCompensation(const ActuatorProfile& profile, const effects::Compensation& compensation,
                          const effects::CompensationSettings& settings) {
    resultStream() << "\nCompensation, at most +" << fixedDecimals(settings.maximumBoostDecibels, 1) << " dB\n";
    if (compensation.isTransparent()) {
        resultStream() << "  none: the profile asks for no change\n";
        return;
    }
    resultStream() << "  band          " << fixedDecimals(compensation.bandHz()[0], 0) << " to "
                   << fixedDecimals(compensation.bandHz()[1], 0) << " Hz, levelled to "
                   << fixedDecimals(compensation.levelDecibels(), 1) << " dB\n"
                   << "  latency       " << fixedDecimals(compensation.latencySeconds() * 1000.0, 1)
                   << " ms at the latest frequency of the band, "
                   << fixedDecimals(compensation.groupDelaySeconds(250.0) * 1000.0, 1) << " ms at 250 Hz\n"
                   << "  tail, memory  " << fixedDecimals(compensation.tailSeconds(), 2) << " s, "
                   << sizeof(compensation) << " bytes\n\n"
                   << "      Hz  actuator dB  compensation dB  together dB\n";
    for (const double hz : {20.0, 25.0, 31.5, 40.0, 50.0, 63.0, 80.0, 100.0, 125.0, 160.0, 200.0, 250.0, 315.0, 400.0,
                            500.0, 630.0, 800.0, 1000.0}) {
        const double actuator = profile.magnitudeDecibelsAt(hz);
        const double gain = compensation.gainDecibels(hz);
        resultStream() << std::setw(8) << fixedDecimals(hz, 1) << std::setw(13) << fixedDecimals(actuator, 1)
                       << std::setw(17) << fixedDecimals(gain, 1) << std::setw(13) << fixedDecimals(actuator + gain, 1)
                       << '\n';
    }
}

std::string plotOf(const ActuatorProfile& profile, const effects::Compensation& compensation) {
    std::vector<double> frequencyHz;
    std::vector<double> actuator;
    std::vector<double> gain;
    std::vector<double> together;
    for (int point = 0; point <= 240; ++point) {
        const double hz = 20.0 * std::pow(60.0, point / 240.0);
        frequencyHz.push_back(hz);
        actuator.push_back(profile.magnitudeDecibelsAt(hz));
        gain.push_back(compensation.gainDecibels(hz));
        together.push_back(actuator.back() + gain.back());
    }
    return svgPlot(profile.name + (profile.isApproximate ? " (approximate)" : "") + " and its compensation",
                   frequencyHz,
                   {decibelPanel({{"actuator", actuatorColour, actuator},
                                  {"compensation", compensationColour, gain, true},
                                  {"together", togetherColour, together}},
                                 -60.0)});
}

void describeLabels(const ShowOptions& options, const ActuatorProfile& profile) {
    const std::filesystem::path path = findModel(options.modelPath);
    const std::vector<TextureDistance> distances = textureDistances(readModel(path), profile, options.compensation);
    std::size_t width = 5;
    for (const TextureDistance& each : distances) {
        width = std::max(width, each.label.size());
    }
    resultStream() << "\nLog-spectral distance between the texture and what this actuator plays, 20-1000 Hz, dB\n  "
                   << std::left << std::setw(static_cast<int>(width)) << "label" << std::right
                   << "  uncompensated  compensated\n";
    for (const TextureDistance& each : distances) {
        resultStream() << "  " << std::left << std::setw(static_cast<int>(width)) << each.label << std::right
                       << std::setw(15) << fixedDecimals(each.uncompensatedDecibels, 2) << std::setw(13)
                       << fixedDecimals(each.compensatedDecibels, 2) << '\n';
    }
}

void runShow(const ShowOptions& options) {
    if (!options.modelPath.empty() && !options.labels) {
        throw UsageError("--model has no effect without --labels; give both or neither");
    }
    const ActuatorProfile profile = readActuatorProfile(options.profile);
    const OptionalOutput plot = optionalOutput("--plot", options.plotPath);
    constexpr double shownRateHz = 48000.0;
    const effects::Compensation compensation(profile, shownRateHz, options.compensation);
    describe(profile);
    describeCompensation(profile, compensation, options.compensation);
    if (options.labels) {
        describeLabels(options, profile);
    }
    writeText(plot, plotOf(profile, compensation));
    commit(plot);
}

void addSweep(CLI::App& actuator) {
    CLI::App* command = actuator.add_subcommand("sweep", "Write the sweep that is played to measure an actuator");
    const auto options = std::make_shared<SweepOptions>();
    command->add_option("-o,--output", options->outputPath, "The WAV file, one channel of 32-bit float")
        ->required()
        ->type_name("SWEEP.wav");
    command->add_option("--rate", options->rateHz, "Sample rate of the audio device in Hz")
        ->transform(outputRate())
        ->capture_default_str();
    command->add_option("--seconds", options->sweep.seconds, "Duration; a longer sweep is less sensitive to noise")
        ->check(decimalBetween(1.0, 120.0, "s"))
        ->capture_default_str();
    command->add_option("--from-hz", options->sweep.fromHz, "Frequency at the start")
        ->check(decimalBetween(5.0, 10000.0, "Hz"))
        ->capture_default_str();
    command->add_option("--to-hz", options->sweep.toHz, "Frequency at the end")
        ->check(decimalBetween(10.0, 20000.0, "Hz"))
        ->capture_default_str();
    command->add_option("--level", options->sweep.level, "Amplitude, a share of full scale")
        ->check(decimalBetween(0.001, 1.0, ""))
        ->capture_default_str();
    command->footer(
        "An exponential sine sweep followed by a second of silence: record until the silence is over. The file holds\n"
        "the sweep's parameters as a comment, which `identify` reads.\n"
        "An actuator moves most at its resonance: begin with a low --level and raise it until the recording is well\n"
        "above the noise.\n"
        "Example:\n"
        "  haptoflow actuator sweep -o sweep.wav --level 0.1");
    command->callback([options] { runSweep(*options); });
}

void addIdentify(CLI::App& actuator) {
    CLI::App* command = actuator.add_subcommand("identify", "Make an actuator's profile from its recorded sweep");
    const auto options = std::make_shared<IdentifyOptions>();
    command->add_option("recording", options->recordingPath, "The sensor's recording, at any rate from 8 to 192 kHz")
        ->required()
        ->type_name("RECORDING.wav");
    command->add_option("--sweep", options->sweepPath, "The file that was played, as `sweep` wrote it")
        ->required()
        ->type_name("SWEEP.wav");
    command->add_option("-o,--output", options->outputPath, "The profile")->required()->type_name("PROFILE.json");
    command->add_option("--plot", options->plotPath, "Magnitude, distortion, noise and phase as a picture")
        ->type_name("PLOT.svg");
    command->add_option("--name", options->name, "Name of the profile (default: the file's name)")
        ->check([](const std::string& name) {
            const bool isPlain = model::isUtf8(name) && !model::hasControlCharacter(name);
            return isPlain && !name.empty() && name.size() <= 128
                       ? std::string()
                       : std::string("expected one line of 1 to 128 bytes in UTF-8");
        });
    command->add_option("--channel", options->channel, "Channel of the recording, from 1; needed if it has several")
        ->transform(wholeBetween(1, 1024, ""));
    command
        ->add_option("--mps2-per-unit", options->mps2PerUnit,
                     "m/s^2 of a sample of 1 in the recording, for a calibrated sensor: sets the rated level")
        ->check(decimalBetween(1e-6, 1e6, "m/s^2"));
    command->footer(
        "Fix an accelerometer where the fingers hold the pen, start recording, play the sweep through the actuator,\n"
        "stop after the silence. Hold the pen as in use: the hand is part of the measurement.\n"
        "The profile holds magnitude (the strongest frequency is 0 dB) and phase, smoothed over a twelfth of an "
        "octave,\n"
        "resonances, and the measurement's delay, distortion and signal to noise; frequencies at either end that do "
        "not\n"
        "stand out of the noise are left out.\n"
        "Example:\n"
        "  haptoflow actuator identify recording.wav --sweep sweep.wav -o pen.json --plot pen.svg\n"
        "Format and law are explained in Documentation~/devices.md.");
    command->callback([options] { runIdentify(*options); });
}

void addShow(CLI::App& actuator) {
    CLI::App* command = actuator.add_subcommand("show", "Print a profile, and the effect of compensating for it");
    const auto options = std::make_shared<ShowOptions>();
    command->add_option("profile", options->profile, "A profile's file, or a built-in one: flat, voice-coil")
        ->required()
        ->type_name("PROFILE");
    command->add_option("--boost", options->compensation.maximumBoostDecibels, "Maximum gain of the compensation")
        ->check(decimalBetween(0.0, 24.0, "dB"))
        ->capture_default_str();
    command->add_option("--plot", options->plotPath, "Actuator, compensation and both together as a picture")
        ->type_name("PLOT.svg");
    command->add_flag("--labels", options->labels,
                      "Add, for each label of the model, the distance between the played texture and the original");
    command->add_option("--model", options->modelPath, "Model file for --labels (default: the one shipped)")
        ->type_name("FILE");
    command->footer(
        "Example:\n"
        "  haptoflow actuator show voice-coil --labels --plot voice-coil.svg");
    command->callback([options] { runShow(*options); });
}

}  // namespace

void addActuatorCommand(CLI::App& app) {
    CLI::App* command = app.add_subcommand("actuator", "Measure an actuator, and show its compensation");
    command->require_subcommand(1);
    addSweep(*command);
    addIdentify(*command);
    addShow(*command);
    command->footer(
        "The steps: write the sweep, play it through the actuator while an accelerometer records, identify, show.\n"
        "  haptoflow actuator sweep -o sweep.wav\n"
        "  haptoflow actuator identify recording.wav --sweep sweep.wav -o pen.json --plot pen.svg\n"
        "  haptoflow actuator show pen.json --labels");
}

}  // namespace haptoflow::cli
