#include "commands.hpp"
#include "headless/command_files.hpp"
#include "learn_output.hpp"
#include "learning/learner.hpp"
#include "messages.hpp"
#include "model/header_node.hpp"
#include "model/model_file.hpp"
#include "model/plain_text.hpp"
#include "option_values.hpp"
#include "output_file.hpp"
#include "recordings/recording_reader.hpp"
#include "recordings/table_rows.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

namespace haptoflow::cli {
namespace {

namespace fs = std::filesystem;

struct LearnOptions {
    std::string recordingPath;
    std::string outputPath;
    std::string modelPath;
    std::string reportPath;
    std::optional<std::string> name;
    std::string picturePath;
    std::string category;
    std::string licence;
    recordings::RecordingWords words;
    double secondsLimit = learning::defaultSecondsLimit;
    std::uint64_t seed = 1;
    bool quiet = false;
};

/// The texts of the command line are checked by the rules of material files before anything is read.
void requireTexts(const LearnOptions& options) {
    const auto isLine = [](const std::string& text, std::size_t longest) {
        return text.size() <= longest && model::isUtf8(text) && !model::hasControlCharacter(text);
    };
    const auto require = [&](const char* option, const std::string& text, std::size_t longest) {
        if (!isLine(text, longest)) {
            throw UsageError(std::string(option) + " '" + std::string(model::shortened(text, 60)) +
                             "': expected one line of text in UTF-8, without control characters, of " +
                             std::to_string(longest) + " bytes at most");
        }
    };
    require("--category", options.category, model::nameBytes);
    require("--licence", options.licence, model::maximumTextBytes);
    if (options.name) {
        const std::string& name = *options.name;
        const bool hasCapitals = std::ranges::any_of(name, [](char each) { return each >= 'A' && each <= 'Z'; });
        if (recordings::trimmed(name).empty() || hasCapitals || !isLine(name, model::nameBytes)) {
            throw UsageError("--name '" + std::string(model::shortened(name, 60)) + "': expected 1 to " +
                             std::to_string(model::nameBytes) +
                             " characters without capital letters, as labels have, in one line and not all blank");
        }
    }
}

/// The default output: named by words of the command line alone, because a name in a file must not choose a path.
fs::path defaultOutput(const LearnOptions& options) {
    return fileNameOf(options.name ? *options.name : fs::path(options.recordingPath).stem().string()) +
           ".haptomaterial";
}

std::string noiseOf(const learning::LearningReport& report) {
    const std::string found = recordings::plainNumber(report.noiseMps2) + " m/s^2 RMS, removed; found ";
    switch (report.noiseSource) {
        case recordings::NoiseSource::rest:
            return found + "where the tip rests";
        case recordings::NoiseSource::quietPart:
            return found + "where the tip is slowest";
        case recordings::NoiseSource::none:
            break;
    }
    return "none found, so nothing was removed";
}

void tell(const learning::LearningReport& report, const std::string& name, const fs::path& output) {
    resultStream() << "Learnt " << name << " from " << fixedDecimals(report.slidingSeconds, 1) << " s of sliding in "
                   << fixedDecimals(report.seconds, 1) << " s: " << model::printable(output.string()) << '\n'
                   << "  start label        " << report.startLabel << " (" << fixedDecimals(report.startDistanceDb, 1)
                   << " dB away, " << fixedDecimals(report.fittedDistanceDb, 1) << " dB after the fit, "
                   << fixedDecimals(report.spectralDistanceDb, 1) << " dB between the mean spectra behind the tone)\n"
                   << "  nearest label      " << report.nearestLabel << '\n'
                   << "  level error        " << fixedDecimals(report.levelErrorDb, 2)
                   << " dB at most over the speeds\n"
                   << "  sensor noise       " << noiseOf(report) << '\n'
                   << "  speed              " << inMillimetres(report.speedMps[0]) << " to "
                   << inMillimetres(report.speedMps[1]) << " mm/s, level as speed^"
                   << fixedDecimals(report.speedExponent, 2) << '\n'
                   << "  force              " << fixedDecimals(report.forceNewtons[0], 2) << " to "
                   << fixedDecimals(report.forceNewtons[1], 2) << " N, level as force^"
                   << fixedDecimals(report.forceExponent, 2) << '\n'
                   << "  ribs               ";
    if (report.waveVectors.empty()) {
        resultStream() << "none found";
    }
    for (std::size_t i = 0; i < report.waveVectors.size(); ++i) {
        const learning::WaveVector& each = report.waveVectors[i];
        resultStream() << (i > 0 ? ", " : "every ") << fixedDecimals(1.0 / std::hypot(each.x, each.y), 2) << " mm";
    }
    if (!report.waveVectors.empty()) {
        resultStream() << "; the material's first axis lies across them, " << fixedDecimals(report.turnDegrees, 0)
                       << " degrees from the recording's";
    }
    resultStream() << '\n';
    if (!report.recordNext.empty()) {
        resultStream() << "  to gain most       " << report.recordNext << '\n';
    }
    for (const learning::TierDistance& each : report.otherTiers) {
        if (each.isFurtherOff) {
            resultStream() << "  tier " << each.tier << " is further off: " << fixedDecimals(each.spectralDistanceDb, 1)
                           << " dB between the mean spectra; the tone was fitted for another tier\n";
        }
    }
    std::ranges::for_each(report.warnings, note);
}

recordings::MaterialRecording readRecording(const LearnOptions& options) {
    const std::string& path = options.recordingPath;
    const recordings::RecordingWords& words = options.words;
    if (words.fullScaleMps2 && recordings::endingOf(path) == ".csv") {
        throw UsageError("--full-scale-mps2 is for WAV; the columns of " + path + " have units of their own");
    }
    recordings::DiskFiles files(headless::claimInput);
    try {
        recordings::MaterialRecording recording = recordings::readMaterialRecording(files, path, words);
        if (words.speedMps && !recording.velocityMps.empty()) {
            throw UsageError("--speed-mps: " + path + " has a motion of its own; leave the option out");
        }
        if (words.forceNewtons && !recording.forceNewtons.empty()) {
            throw UsageError("--force-newtons: " + path + " has a force of its own; leave the option out");
        }
        recordings::requireMotionAndForce(recording.description, path, recording.hasMotion(), recording.hasForce(),
                                          "--speed-mps", "--force-newtons");
        std::ranges::for_each(recording.description.notes, note);
        return recording;
    } catch (const recordings::RecordingUnusable& error) {
        throw InputError(error.what());
    }
}

void runLearn(const LearnOptions& options) {
    requireTexts(options);
    const recordings::MaterialRecording recording = readRecording(options);
    const fs::path modelPath = findModel(options.modelPath);
    const model::ModelFile model = readModel(modelPath);
    const model::Tier& tier = model.header().tiers[model.header().defaultTier];

    learning::LearningSettings settings;
    settings.name = options.name.value_or(recordings::materialName(recording.description, options.recordingPath));
    settings.category = options.category;
    settings.licence = options.licence.empty() ? recording.description.licence : options.licence;
    settings.recordings = recordings::provenanceOf(recording.description, options.recordingPath);
    settings.seed = options.seed;
    settings.secondsLimit = options.secondsLimit;
    const ProgressBar bar = progressBar("learn", options.quiet);
    settings.progress = [&](double share, const char* doing) { bar(share, doing); };

    try {
        learning::checkSettings(settings);
    } catch (const std::invalid_argument& error) {
        throw InputError(options.recordingPath + ": " + error.what());
    }
    const fs::path outputPath = options.outputPath.empty() ? defaultOutput(options) : fs::path(options.outputPath);
    OutputFile output("--output", outputPath);
    const OptionalOutput picture = optionalOutput("--picture", options.picturePath);
    const OptionalOutput report = optionalOutput("--report", options.reportPath);
    try {
        const learning::LearntMaterial learnt =
            learning::learnMaterial(recording.view(), model, tier, openRuntimeFor(model.header().tiers), settings);
        writeText(output, learnt.materialJson);
        writeText(report, learning::reportJson(learnt.report));
        writeText(picture, learningPicture(learnt.report, settings.name));
        output.commit();
        commit(report);
        commit(picture);
        tell(learnt.report, settings.name, outputPath);
    } catch (const recordings::RecordingUnusable& error) {
        throw InputError(options.recordingPath + ": " + error.what());
    } catch (const std::invalid_argument& error) {
        // The settings were checked: it is the model that cannot learn.
        throw InputError(modelPath.string() + ": " + error.what());
    }
}

}  // namespace

void addLearnCommand(CLI::App& app) {
    CLI::App* command =
        app.add_subcommand("learn", "Learn a material from a recording: ten seconds of one surface, at many speeds");
    const auto options = std::make_shared<LearnOptions>();
    command->add_option("recording", options->recordingPath, "Vibration of one or three axes, with motion and force")
        ->required()
        ->type_name("RECORDING.(csv|wav)");
    command
        ->add_option("-o,--output", options->outputPath,
                     "The material file (default: the --name or the recording's file name with .haptomaterial, here)")
        ->type_name("NAME.haptomaterial");
    command->add_option("--model", options->modelPath, "Model file (default: the one shipped)")->type_name("FILE");
    command->add_option("--name", options->name,
                        "The material's name (default: the sidecar's label, or the recording's file name)");
    command->add_option("--category", options->category, "For example wood (default: the start label's)");
    command->add_option("--speed-mps", options->words.speedMps, "Speed in m/s, for a recording without motion")
        ->check(decimalBetween(0.001, 10.0, "m/s"));
    command->add_option("--force-newtons", options->words.forceNewtons, "Force in N, for a recording without force")
        ->check(decimalBetween(0.02, 100.0, "N"));
    command
        ->add_option("--force-sign", options->words.forceSign,
                     "-1 where the force's column counts pressing as negative (default: the sidecar's, or 1)")
        ->check(CLI::IsMember({"1", "-1"}))
        ->type_name("1|-1");
    command
        ->add_option("--force-rest-newtons", options->words.forceRestNewtons,
                     "What the force's column reads in the air, which is subtracted (default: the sidecar's, or 0)")
        ->check(decimalBetween(-100.0, 100.0, "N"));
    command
        ->add_option("--full-scale-mps2", options->words.fullScaleMps2, "Acceleration in m/s^2 that is +-1 in the WAV")
        ->check(decimalBetween(0.01, 100'000.0, "m/s^2"));
    command->add_option("--licence", options->licence, "Licence of the recording (default: the sidecar's, or unknown)");
    command
        ->add_option(
            "--seconds-limit", options->secondsLimit,
            "Stop fitting after this many seconds; a fit that is not stopped gives the same result on every run")
        ->check(decimalBetween(1.0, 3600.0, "s"))
        ->capture_default_str();
    command->add_option("--seed", options->seed, "Seed of the fit: equal seeds give equal bytes")
        ->transform(wholeBetween(0, std::numeric_limits<std::uint64_t>::max(), ""))
        ->capture_default_str();
    command->add_option("--report", options->reportPath, "Write the results of the fit as JSON")->type_name("R.json");
    command
        ->add_option("--picture", options->picturePath,
                     "Draw recording, material and nearest label: spectra, levels, kurtosis and ribs at each speed")
        ->type_name("P.svg");
    command->add_flag("--quiet", options->quiet, "No progress bar");
    command->footer(
        "Examples:\n"
        "  haptoflow learn denim.csv -o denim.haptomaterial\n"
        "  haptoflow learn doormat.wav --full-scale-mps2 100 --speed-mps 0.08 --force-newtons 1\n"
        "  haptoflow learn tile.csv --name \"kitchen tile\" --category ceramic --report tile.report.json --picture "
        "tile.svg\n"
        "Columns of a CSV: time_s; acceleration_mps2 or acceleration_x_mps2, ..y.., ..z.. (or .._g); speed_mps,\n"
        "velocity_x_mps with velocity_y_mps, or position_x_mm with position_y_mm; force_newtons. Constant values may "
        "be\n"
        "in NAME.json beside NAME.csv or NAME.wav: {\"full_scale_mps2\": 100, \"speed_mps\": 0.08,\n"
        "\"force_newtons\": 1.0, \"label\": \"doormat\", \"licence\": \"CC BY 4.0\"}.\n"
        "Record strokes at slow and fast speeds, in all directions of interest: properties that the recording does "
        "not\n"
        "show are taken from the label that renders most like it.");
    command->callback([options] { runLearn(*options); });
}

}  // namespace haptoflow::cli
