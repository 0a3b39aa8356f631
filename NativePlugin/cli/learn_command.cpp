#include "commands.hpp"
#include "decimal_number.hpp"
#include "exit_codes.hpp"
#include "inference/onnx_segment_generator.hpp"
#include "inference/tier_graphs.hpp"
#include "learning/learner.hpp"
#include "material_recording.hpp"
#include "model/model_file.hpp"
#include "model_location.hpp"
#include "option_values.hpp"
#include "output_file.hpp"
#include "progress_bar.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <limits>
#include <memory>
#include <optional>
#include <string>

namespace haptoflow::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t batchOfFit = 64;
constexpr std::size_t maximumName = 128;

struct LearnOptions {
    std::string recordingPath;
    std::string outputPath;
    std::string modelPath;
    std::string reportPath;
    std::optional<std::string> name;
    std::string category;
    std::string licence;
    RecordingWords words;
    double secondsLimit = learning::defaultSecondsLimit;
    std::uint64_t seed = 1;
    bool quiet = false;
};

/// A material's name from a file's name or a sidecar's label: lower case, without punctuation at its ends.
std::string plainName(const std::string& text) {
    std::string name;
    for (const char letter : text) {
        const auto code = static_cast<unsigned char>(letter);
        const bool isSpace = letter == '_' || letter == '-' || std::isspace(code) != 0 || std::iscntrl(code) != 0;
        name += isSpace ? ' ' : static_cast<char>(code < 0x80U ? std::tolower(code) : code);
    }
    const std::size_t first = name.find_first_not_of(' ');
    if (first == std::string::npos) {
        return "material";
    }
    name = name.substr(first, name.find_last_not_of(' ') - first + 1);
    return name.substr(0, maximumName);
}

void requireName(const std::string& name) {
    const bool isPlain = !name.empty() && name.size() <= maximumName && std::ranges::none_of(name, [](char letter) {
        return std::iscntrl(static_cast<unsigned char>(letter)) != 0 || (letter >= 'A' && letter <= 'Z');
    });
    if (!isPlain) {
        throw UsageError("--name '" + name + "': expected 1 to " + std::to_string(maximumName) +
                         " characters without capital letters, as labels have");
    }
}

std::string inMillimetres(double mps) {
    return fixedDecimals(1000.0 * mps, 0);
}

void tell(const learning::LearningReport& report, const std::string& name, const fs::path& output) {
    std::cout << "Learnt " << name << " from " << fixedDecimals(report.slidingSeconds, 1) << " s of sliding in "
              << fixedDecimals(report.seconds, 1) << " s: " << output.string() << '\n'
              << "  nearest label      " << report.nearestLabel << " (" << fixedDecimals(report.nearestDistanceDb, 1)
              << " dB away, " << fixedDecimals(report.fittedDistanceDb, 1) << " dB after the fit, "
              << fixedDecimals(report.spectralDistanceDb, 1) << " dB between the mean spectra behind the tone)\n"
              << "  level error        " << fixedDecimals(report.levelErrorDb, 2) << " dB at most over the speeds\n"
              << "  speed              " << inMillimetres(report.speedMps[0]) << " to "
              << inMillimetres(report.speedMps[1]) << " mm/s, level as speed^" << fixedDecimals(report.speedExponent, 2)
              << '\n'
              << "  force              " << fixedDecimals(report.forceNewtons[0], 2) << " to "
              << fixedDecimals(report.forceNewtons[1], 2) << " N, level as force^"
              << fixedDecimals(report.forceExponent, 2) << '\n'
              << "  ribs               ";
    if (report.waveVectors.empty()) {
        std::cout << "none found";
    }
    for (std::size_t i = 0; i < report.waveVectors.size(); ++i) {
        const learning::LearntWaveVector& each = report.waveVectors[i];
        std::cout << (i > 0 ? ", " : "every ") << fixedDecimals(1.0 / std::hypot(each.x, each.y), 2) << " mm";
    }
    if (!report.waveVectors.empty()) {
        std::cout << "; the material's first axis lies across them, " << fixedDecimals(report.turnDegrees, 0)
                  << " degrees from the recording's";
    }
    std::cout << '\n' << "  seeds              " << report.seeds << '\n';
    for (const std::string& warning : report.warnings) {
        std::cerr << "haptoflow: note: " << warning << '\n';
    }
}

void runLearn(const LearnOptions& options) {
    if (options.name) {
        requireName(*options.name);
    }
    const MaterialRecording recording = readMaterialRecording(options.recordingPath, options.words);
    for (const std::string& note : recording.notes) {
        std::cerr << "haptoflow: note: " << note << '\n';
    }
    const fs::path modelPath = findModel(options.modelPath);
    const model::ModelFile model = readModel(modelPath);
    const model::Tier& tier = model.header().tiers[model.header().defaultTier];

    learning::LearningSettings settings;
    settings.name = options.name ? *options.name
                                 : plainName(recording.label.empty() ? fs::path(options.recordingPath).stem().string()
                                                                     : recording.label);
    settings.category = options.category;
    settings.licence = options.licence.empty() ? recording.licence : options.licence;
    settings.recordings =
        fs::path(options.recordingPath).filename().string() + (recording.source.empty() ? "" : ", " + recording.source);
    settings.seed = options.seed;
    settings.secondsLimit = options.secondsLimit;
    const ProgressBar bar = progressBar("learn", options.quiet);
    settings.progress = [&](double share, const char* doing) { bar(share, doing); };

    const fs::path outputPath = options.outputPath.empty() ? settings.name + ".haptomaterial" : options.outputPath;
    const std::array<NamedPath, 2> outputs{NamedPath{"--output", outputPath},
                                           NamedPath{"--report", options.reportPath}};
    const std::array<NamedPath, 2> inputs{NamedPath{"the recording", options.recordingPath},
                                          NamedPath{"the model", modelPath}};
    requireApart(outputs, inputs);
    OutputFile output(outputPath);
    std::optional<OutputFile> report;
    if (!options.reportPath.empty()) {
        report.emplace(options.reportPath);
    }
    inference::OnnxSegmentGenerator generator(openRuntime(), model, tier.name, inference::defaultSolver(tier),
                                              batchOfFit);
    try {
        const learning::LearntMaterial learnt = learning::learnMaterial(recording.view(), model, generator, settings);
        writeText(output, learnt.materialJson);
        if (report) {
            writeText(*report, learning::reportJson(learnt.report));
        }
        output.commit();
        if (report) {
            report->commit();
        }
        tell(learnt.report, settings.name, outputPath);
    } catch (const learning::RecordingUnusable& error) {
        throw InputError(options.recordingPath + ": " + error.what());
    }
}

}  // namespace

void addLearnCommand(CLI::App& app, CommandOutcome& outcome) {
    CLI::App* command =
        app.add_subcommand("learn", "Learn a material from a recording: ten seconds of one surface, at many speeds");
    const auto options = std::make_shared<LearnOptions>();
    command->add_option("recording", options->recordingPath, "Vibration of one or three axes, with motion and force")
        ->required()
        ->type_name("RECORDING.(csv|wav)");
    command
        ->add_option("-o,--output", options->outputPath,
                     "The material file (default: the name with .haptomaterial, here)")
        ->type_name("NAME.haptomaterial");
    command->add_option("--model", options->modelPath, "Model file (default: the one shipped)")->type_name("FILE");
    command->add_option("--name", options->name,
                        "The material's name (default: the sidecar's label, or the recording's file name)");
    command->add_option("--category", options->category, "For example wood (default: the nearest label's)");
    command->add_option("--speed-mps", options->words.speedMps, "Speed in m/s, for a recording without motion")
        ->check(decimalBetween(0.001, 10.0, "m/s"));
    command->add_option("--force-newtons", options->words.forceNewtons, "Force in N, for a recording without force")
        ->check(decimalBetween(0.02, 100.0, "N"));
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
    command->add_flag("--quiet", options->quiet, "No progress bar");
    command->footer(
        "Examples:\n"
        "  haptoflow learn denim.csv -o denim.haptomaterial\n"
        "  haptoflow learn doormat.wav --full-scale-mps2 100 --speed-mps 0.08 --force-newtons 1\n"
        "  haptoflow learn tile.csv --name \"kitchen tile\" --category ceramic --report tile.json\n"
        "Columns of a CSV: time_s; acceleration_mps2 or acceleration_x_mps2, ..y.., ..z.. (or .._g); speed_mps,\n"
        "velocity_x_mps with velocity_y_mps, or position_x_mm with position_y_mm; force_newtons. Constant values may "
        "be\n"
        "in NAME.json beside NAME.csv or NAME.wav: {\"full_scale_mps2\": 100, \"speed_mps\": 0.08,\n"
        "\"force_newtons\": 1.0, \"label\": \"doormat\", \"licence\": \"CC BY 4.0\"}.\n"
        "Record strokes at slow and fast speeds, in all directions of interest: properties that the recording does "
        "not\n"
        "show are taken from the nearest label of the model.");
    command->callback([options, &outcome] {
        runLearn(*options);
        outcome.exitCode = exitDone;
    });
}

}  // namespace haptoflow::cli
