#include "clips/clip_making.hpp"
#include "commands.hpp"
#include "effects/device_loudness.hpp"
#include "effects/wave_features.hpp"
#include "engine/offline_renderer.hpp"
#include "headless/scene.hpp"
#include "headless/scene_materials.hpp"
#include "inference/tier_generator.hpp"
#include "messages.hpp"
#include "model/model_file.hpp"
#include "model/plain_text.hpp"
#include "option_values.hpp"
#include "output_file.hpp"
#include "render_output.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace haptoflow::cli {
namespace {

/// Of the WAV files; a whole multiple of the features' rate.
constexpr double rateHz = 48000.0;
constexpr auto samplesPerFeature = static_cast<std::size_t>(rateHz / effects::WaveFeatures::sampleRateHz);
constexpr double stateRateHz = 100.0;
/// Rendered before a clip, so that it begins in the middle of a stroke.
constexpr double leadInSeconds = 0.5;
constexpr double crossfadeSeconds = 0.1;
/// A loop may be shorter by this, where its end then resembles its beginning.
constexpr double searchSeconds = 0.25;

struct ExportOptions {
    std::string folder;
    std::string modelPath;
    std::string quality;
    std::vector<std::string> labels;
    std::vector<std::string> materials;
    std::vector<double> speedsMps{0.03, 0.1, 0.3};
    std::vector<double> forcesNewtons{0.5, 1.0, 2.0};
    std::vector<std::string> formats{"wav", "haptic"};
    double seconds = 4.0;
    std::uint64_t seed = 1;
    bool quiet = false;
};

/// A loop of a stroke that never ends, in m/s^2.
struct Loop {
    std::vector<float> wave;
    /// The same at the features' rate.
    std::vector<float> slowWave;
};

/// So many rounds of a loop.
std::vector<float> repeated(std::span<const float> loop, int rounds) {
    std::vector<float> wave;
    for (int round = 0; round < rounds; ++round) {
        wave.insert(wave.end(), loop.begin(), loop.end());
    }
    return wave;
}

/// A loop at the features' rate: the second of three rounds, so that the filter knows what is before and after.
std::vector<float> slowLoop(std::span<const float> loop) {
    const std::vector<float> slow = effects::decimated(repeated(loop, 3), samplesPerFeature);
    const auto count = static_cast<std::ptrdiff_t>(loop.size() / samplesPerFeature);
    return {slow.begin() + count, slow.begin() + 2 * count};
}

/// What a voice coil plays of a loop: by the loudness law, +-1.
std::vector<float> onDevice(std::span<const float> loop) {
    effects::EnvelopeGain device = effects::deviceWave(rateHz);
    std::vector<float> rounds = repeated(loop, 3);
    device.process(rounds);
    const auto delay = static_cast<std::ptrdiff_t>(effects::EnvelopeGain::latencySeconds * rateHz);
    const auto first = rounds.begin() + static_cast<std::ptrdiff_t>(loop.size()) + delay;
    return {first, first + static_cast<std::ptrdiff_t>(loop.size())};
}

/// Renders the loops of one set.
class LoopRenderer {
public:
    LoopRenderer(const ExportOptions& options, const model::ModelFile& model, const model::Tier& tier,
                 std::vector<model::MaterialFile> materials)
        : options_(options),
          model_(model),
          generator_(inference::makeGenerator(openRuntimeFor(std::span(&tier, 1)), model, tier,
                                              inference::defaultSolver(tier), 1)) {
        settings_.outputRateHz = rateHz;
        settings_.seed = options.seed;
        settings_.materials = std::move(materials);
    }

    [[nodiscard]] Loop render(std::uint32_t material, double speedMps, double forceNewtons) {
        engine::TimedContactState state;
        state.touching = 1;
        state.touchCounter = 1;
        state.material.add(material, 1.0F);
        state.velocityMps = {static_cast<float>(speedMps), 0.0F};
        state.forceNewtons = static_cast<float>(forceNewtons);
        const double wholeSeconds = leadInSeconds + options_.seconds + crossfadeSeconds + 0.02;
        std::vector<engine::TimedContactState> states;
        while (state.timeSeconds <= wholeSeconds) {
            states.push_back(state);
            state.timeSeconds = static_cast<double>(states.size()) / stateRateHz;
        }
        std::vector<float> wave = engine::renderOffline(model_, *generator_, states, settings_).samples;
        std::ranges::for_each(wave, [this](float& sample) { sample *= settings_.fullScaleMps2; });
        const auto samples = [](double seconds) { return static_cast<std::size_t>(std::llround(seconds * rateHz)); };
        // Both rates hold a loop of whole samples.
        std::vector<float> loop =
            clips::loopOf(std::span(wave).subspan(samples(leadInSeconds), samples(options_.seconds + crossfadeSeconds)),
                          samples(options_.seconds - searchSeconds), samples(options_.seconds),
                          samples(crossfadeSeconds), samplesPerFeature);
        std::vector<float> slow = slowLoop(loop);
        return {.wave = std::move(loop), .slowWave = std::move(slow)};
    }

private:
    const ExportOptions& options_;
    const model::ModelFile& model_;
    std::unique_ptr<inference::SegmentGenerator> generator_;
    engine::OfflineSettings settings_;
};

std::string withUnderscores(const std::string& label) {
    std::string name = label;
    std::ranges::replace_if(
        name, [](unsigned char letter) { return std::isalnum(letter) == 0 && letter != '-' && letter < 0x80U; }, '_');
    return name;
}

/// File names of labels, all different.
std::vector<std::string> namesOf(const std::vector<std::string>& labels) {
    std::set<std::string> taken;
    std::vector<std::string> names;
    for (const std::string& label : labels) {
        std::string name = withUnderscores(label);
        for (int number = 2; !taken.insert(name).second; ++number) {
            name = withUnderscores(label) + '-' + std::to_string(number);
        }
        names.push_back(name);
    }
    return names;
}

/// The files of a set, in a folder that holds no other thing.
class SetFolder {
public:
    explicit SetFolder(const std::filesystem::path& folder) : folder_(folder) {
        std::error_code error;
        if (std::filesystem::exists(folder, error) && !std::filesystem::is_directory(folder, error)) {
            throw UsageError("-o " + folder.string() + ": expected a folder");
        }
        std::filesystem::create_directories(folder, error);
        if (error) {
            throw InputError("-o " + folder.string() + ": cannot be made: " + error.message());
        }
        if (!std::filesystem::is_empty(folder, error) && !std::filesystem::exists(folder / "index.json", error)) {
            throw UsageError("-o " + folder.string() + ": has other files and no index.json; name a new folder");
        }
    }

    /// Writes one clip in all formats and notes their names and the largest error of an amplitude in `entry`.
    void write(const std::string& name, const std::vector<std::string>& formats, const Loop& loop,
               const clips::HapticClip& clip, nlohmann::ordered_json& entry) {
        double errorDb = 0.0;
        for (const std::string& format : formats) {
            const std::string fileName = std::string(name).append(".").append(format);
            OutputFile file("-o", folder_ / fileName);
            if (format == "wav") {
                WavWriter writer(file.partial(), static_cast<int>(rateHz), fileName, clip.origin.description);
                writer.write(onDevice(loop.wave));
                writer.close();
            } else {
                errorDb = std::max(errorDb, writeClipFile(file, clip).amplitudeErrorDb);
            }
            file.commit();
            entry["files"][format] = fileName;
        }
        if (errorDb > 0.0) {
            entry["amplitude_error_db"] = errorDb;
        }
    }

    void finish(const nlohmann::ordered_json& index) {
        OutputFile file("-o", folder_ / "index.json");
        writeText(file, index.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + '\n');
        file.commit();
    }

private:
    std::filesystem::path folder_;
};

void requireRising(const std::string& option, const std::vector<double>& values) {
    if (std::ranges::adjacent_find(values, std::greater_equal<>()) != values.end()) {
        throw UsageError(option + ": expected rising numbers");
    }
}

constexpr const char* howToBlend =
    "Find the two speeds and the two forces around the contact's. Weights run linearly over the logarithm of each; a "
    "clip's gain is the square root of the product of its two weights, because clips are not correlated. Below the "
    "lowest speed multiply by speed / lowest, below the lowest force by force / lowest; above the highest take the "
    "highest. Begin each loop at a place of its own, and let it run.";

void runExportSet(const ExportOptions& options) {
    requireRising("--speeds", options.speedsMps);
    requireRising("--forces", options.forcesNewtons);
    const std::filesystem::path modelPath = findModel(options.modelPath);
    const model::ModelFile model = readModel(modelPath);
    const model::Tier& tier = chooseTier(model, options.quality);
    headless::SceneMaterials materials(model, modelPath, "--labels");
    std::ranges::for_each(options.materials, [&materials](const std::string& path) { materials.add(path); });
    std::vector<std::string> labels = options.labels;
    if (labels.empty()) {
        std::ranges::transform(model.header().labels, std::back_inserter(labels), &model::Label::name);
        std::ranges::transform(materials.files(), std::back_inserter(labels),
                               [](const model::MaterialFile& file) { return file.label.name; });
    }
    headless::Scene scene;
    for (const std::string& label : labels) {
        headless::SceneSurface& surface = scene.surfaces.emplace_back();
        surface.name = label;
        surface.material = {{label, 1.0}};
    }
    materials.require(scene);
    LoopRenderer renderer(options, model, tier, materials.files());
    SetFolder folder(options.folder);

    const ProgressBar bar = progressBar("export-set", options.quiet);
    const std::vector<std::string> names = namesOf(labels);
    const std::size_t count = labels.size() * options.speedsMps.size() * options.forcesNewtons.size();
    std::size_t done = 0;
    nlohmann::ordered_json entries = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < labels.size(); ++i) {
        const std::string& label = scene.surfaces[i].material.begin()->first;
        nlohmann::ordered_json clipsOfLabel = nlohmann::ordered_json::array();
        for (const double speed : options.speedsMps) {
            for (const double force : options.forcesNewtons) {
                bar(static_cast<double>(done++) / static_cast<double>(count), label);
                const Loop loop = renderer.render(materials.indexOf(label), speed, force);
                const std::string what =
                    label + " at " + model::shortNumber(speed) + " m/s and " + model::shortNumber(force) + " N";
                const clips::HapticClip clip = clips::clipOf(
                    loop.slowWave,
                    {.isLoop = true,
                     .origin = {.title = label,
                                .description = what + "; " +
                                               renderedBy(modelPath.filename().string(), tier.name, options.seed,
                                                          model.header().provenance.licence),
                                .editor = "HaptoFlow " HAPTOFLOW_VERSION,
                                .tags = {label, "texture", "loop"}}});
                const std::string name =
                    names[i] + '_' + model::shortNumber(1000.0 * speed) + "mmps_" + model::shortNumber(force) + 'N';
                clipsOfLabel.push_back({{"speed_mps", speed},
                                        {"force_newtons", force},
                                        {"seconds", static_cast<double>(loop.wave.size()) / rateHz},
                                        {"rms_mps2", model::rmsOf(loop.wave)}});
                folder.write(name, options.formats, loop, clip, clipsOfLabel.back());
            }
        }
        entries.push_back({{"label", label}, {"clips", std::move(clipsOfLabel)}});
    }
    folder.finish({{"format", "haptoflow clip set"},
                   {"version", 1},
                   {"editor", "HaptoFlow " HAPTOFLOW_VERSION},
                   {"model", modelPath.filename().string()},
                   {"quality", tier.name},
                   {"seed", options.seed},
                   {"licence", model.header().provenance.licence},
                   {"speeds_mps", options.speedsMps},
                   {"forces_newtons", options.forcesNewtons},
                   {"how_to_blend", howToBlend},
                   {"wav", "48 kHz, one channel, +-1: what a voice coil plays by the loudness law of waveforms"},
                   {"labels", std::move(entries)}});
    bar(1.0, {});
}

}  // namespace

void addExportSetCommand(CLI::App& app) {
    CLI::App* command = app.add_subcommand(
        "export-set", "Render loops of labels over speed and force, for engines that cross-fade clips");
    const auto options = std::make_shared<ExportOptions>();
    command
        ->add_option("-o,--output", options->folder,
                     "Folder for the clips and index.json, which says how to blend them")
        ->required()
        ->type_name("FOLDER");
    command->add_option("--labels", options->labels, "Labels of the model (default: all)")
        ->delimiter(',')
        ->type_name("LIST");
    command
        ->add_option("--material", options->materials,
                     "A .haptomaterial file whose name counts as a label; may be given several times")
        ->allow_extra_args(false)
        ->type_name("FILE");
    command->add_option("--speeds", options->speedsMps, "Speeds in m/s, rising")
        ->delimiter(',')
        ->check(decimalBetween(0.005, 2.0, "m/s"))
        ->type_name("LIST")
        ->capture_default_str();
    command->add_option("--forces", options->forcesNewtons, "Forces in N, rising")
        ->delimiter(',')
        ->check(decimalBetween(0.05, 20.0, "N"))
        ->type_name("LIST")
        ->capture_default_str();
    command
        ->add_option("--seconds", options->seconds, "Longest loop; a quarter of a second less where it closes better")
        ->check(decimalBetween(1.0, 30.0, "s"))
        ->capture_default_str();
    command->add_option("--formats", options->formats, "One or more of wav, haptic, ahap and hjif")
        ->delimiter(',')
        ->check(CLI::IsMember({"wav", "haptic", "ahap", "hjif"}))
        ->type_name("LIST")
        ->capture_default_str();
    command->add_option("--model", options->modelPath, "Model file (default: the one shipped)")->type_name("FILE");
    command->add_option("--quality", options->quality, "A tier of the model; `haptoflow inspect` lists them");
    command->add_option("--seed", options->seed, "Seed of the noise")
        ->transform(wholeBetween(0, std::numeric_limits<std::uint64_t>::max(), ""))
        ->capture_default_str();
    command->add_flag("--quiet", options->quiet, "No progress bar");
    command->footer(
        "Examples:\n"
        "  haptoflow export-set -o clips --labels wood,sandpaper\n"
        "  haptoflow export-set -o phone --labels wood --speeds 0.05,0.2 --forces 1 --seconds 2 --formats ahap,haptic");
    command->callback([options] { runExportSet(*options); });
}

}  // namespace haptoflow::cli
