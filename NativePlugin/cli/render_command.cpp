#include "clips/clip_making.hpp"
#include "commands.hpp"
#include "effects/actuator_profile.hpp"
#include "effects/effect.hpp"
#include "engine/offline_renderer.hpp"
#include "headless/command_files.hpp"
#include "headless/contact_tracker.hpp"
#include "headless/scene_file.hpp"
#include "headless/scene_materials.hpp"
#include "headless/stroke_file.hpp"
#include "inference/tier_generator.hpp"
#include "messages.hpp"
#include "model/model_file.hpp"
#include "option_values.hpp"
#include "output_file.hpp"
#include "recordings/recording.hpp"
#include "render_output.hpp"
#include "scene_reliefs.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace haptoflow::cli {
namespace {

struct RenderOptions {
    std::string scenePath;
    std::string strokePath;
    std::vector<std::string> outputs;
    /// Paths of the outputs; empty if there is none of the kind.
    std::string outputPath;
    std::string parametricPath;
    std::string tablePath;
    std::vector<std::string> clipPaths;
    std::string modelPath;
    std::vector<std::string> materials;
    std::string quality;
    std::string solver;
    std::optional<int> steps;
    std::string reportPath;
    std::string waveformPath;
    std::vector<std::string> effects;
    std::string actuator;
    double delayMs = 0.0;
    engine::OfflineSettings engine;
    bool quiet = false;

    /// Whether the amplitude and frequency over time are asked for.
    [[nodiscard]] bool needsFrames() const {
        return !parametricPath.empty() || !tablePath.empty() || !clipPaths.empty();
    }
};

/// The effects that every surface requests: the texture by default.
effects::EffectMask requestedEffects(const std::vector<std::string>& names) {
    static const std::map<std::string, effects::EffectMask> masks{
        {"none", 0U},
        {"texture", effects::maskOf(effects::EffectKind::texture)},
        {"impact", effects::maskOf(effects::EffectKind::impact)},
        {"edge", effects::maskOf(effects::EffectKind::edge)}};
    effects::EffectMask mask = names.empty() ? masks.at("texture") : 0U;
    for (const std::string& name : names) {
        mask |= masks.at(name);
    }
    return mask;
}

/// The solver of the options, if the tier can use it.
inference::SolverSettings chooseSolver(const model::Tier& tier, const std::string& solver, std::optional<int> steps) {
    if (!steps) {
        return inference::defaultSolver(tier);
    }
    if (!tier.isSolved()) {
        throw UsageError("--solver and --steps have no effect on the tier '" + tier.name +
                         "', which is evaluated once: leave both out, or choose a tier of another kind with --quality "
                         "(`haptoflow inspect` shows kinds)");
    }
    if (tier.kind == model::TierKind::averageVelocity && solver != "euler") {
        throw UsageError("--solver " + solver + " has no effect on the tier '" + tier.name +
                         "', which is always stepped by euler: did you mean --solver euler?");
    }
    constexpr std::array kinds{inference::SolverKind::euler, inference::SolverKind::midpoint,
                               inference::SolverKind::heun};
    return {.kind = *std::ranges::find(kinds, solver, model::solverName), .steps = *steps};
}

/// The number of touch-downs when every sample of the stroke is processed in addition to the frames: a tap may begin
/// and end between two frames.
std::uint64_t touchesOfEverySample(const headless::Scene& scene, const headless::Stroke& stroke, std::size_t frames,
                                   const headless::ContactSettings& settings) {
    headless::ContactTracker tracker(scene, settings);
    std::uint64_t touches = 0;
    bool wasTouching = false;
    const auto look = [&](const headless::TipSample& sample) {
        const bool isTouching = tracker.update(sample).touching;
        touches += isTouching && !wasTouching ? 1U : 0U;
        wasTouching = isTouching;
    };
    auto sample = stroke.samples.begin();
    for (std::size_t frame = 0; frame < frames; ++frame) {
        const headless::TipSample atFrame = headless::frameAt(stroke, scene.updateRateHz, frame);
        for (; sample != stroke.samples.end() && sample->timeSeconds < atFrame.timeSeconds; ++sample) {
            look(*sample);
        }
        look(atFrame);
    }
    for (; sample != stroke.samples.end(); ++sample) {
        look(*sample);
    }
    return touches;
}

std::vector<std::string> labelsIn(const headless::Scene& scene) {
    std::vector<std::string> labels;
    for (const headless::SceneSurface& surface : scene.surfaces) {
        for (const auto& [name, weight] : surface.material) {
            if (std::ranges::find(labels, name) == labels.end()) {
                labels.push_back(name);
            }
        }
    }
    return labels;
}

/// The files of a render: they are written while it runs and appear when all of them are complete.
class RenderFiles final : public engine::OfflineSink {
public:
    explicit RenderFiles(const RenderOptions& options)
        : wav_(optionalOutput("-o", options.outputPath)),
          waveform_(optionalOutput("--waveform", options.waveformPath)),
          report_(optionalOutput("--report", options.reportPath)),
          parametric_(optionalOutput("-o", options.parametricPath)),
          table_(optionalOutput("-o", options.tablePath)),
          fullScaleMps2_(options.engine.fullScaleMps2) {
        if (wav_) {
            wavWriter_.emplace(wav_->partial(), static_cast<int>(options.engine.outputRateHz), options.outputPath);
        }
        if (waveform_) {
            waveformWriter_.emplace(waveform_->partial(), static_cast<int>(inference::waveformRateHz),
                                    options.waveformPath);
        }
        if (options.needsFrames()) {
            frames_.emplace(options.engine.outputRateHz);
        }
        for (const std::string& path : options.clipPaths) {
            clips_.push_back(optionalOutput("-o", path));
        }
    }

    void output(std::span<const float> samples) override {
        if (wavWriter_) {
            wavWriter_->write(samples);
        }
        if (frames_) {
            frames_->take(samples, fullScaleMps2_);
        }
    }

    void waveform(std::span<const float> samplesMps2) override {
        if (waveformWriter_) {
            scaled_.assign(samplesMps2.begin(), samplesMps2.end());
            std::ranges::for_each(scaled_, [this](float& sample) { sample /= fullScaleMps2_; });
            waveformWriter_->write(scaled_);
        }
    }

    /// No samples follow. Writes the clips.
    [[nodiscard]] std::vector<ClipFigures> finish(const clips::ClipOrigin& origin) {
        std::vector<ClipFigures> figures;
        if (frames_) {
            frames_->finish();
        }
        if (!clips_.empty()) {
            const clips::HapticClip clip = clips::clipOf(frames_->wave(), {.origin = origin});
            for (const auto& file : clips_) {
                figures.push_back(writeAndCompareClip(*file, clip, frames_->wave()));
                noteCoarseClip(figures.back());
            }
        }
        return figures;
    }

    void complete(const std::string& report) {
        if (wavWriter_) {
            wavWriter_->close();
        }
        if (waveformWriter_) {
            waveformWriter_->close();
        }
        writeText(report_, report);
        if (parametric_) {
            writeText(parametric_, frames_->toJson());
        }
        if (table_) {
            writeText(table_, frames_->toCsv());
        }
        for (const OptionalOutput* file : {&wav_, &waveform_, &report_, &parametric_, &table_}) {
            commit(*file);
        }
        std::ranges::for_each(clips_, commit);
    }

private:
    OptionalOutput wav_;
    OptionalOutput waveform_;
    OptionalOutput report_;
    OptionalOutput parametric_;
    OptionalOutput table_;
    std::vector<OptionalOutput> clips_;
    std::optional<WavWriter> wavWriter_;
    std::optional<WavWriter> waveformWriter_;
    std::optional<ParametricFrames> frames_;
    float fullScaleMps2_;
    std::vector<float> scaled_;
};

std::string kindOfOutput(std::string_view path) {
    if (const auto clip = clipFormatOf(path)) {
        return std::string(clips::endingOf(*clip));
    }
    return path.ends_with(".json") ? "json" : path.ends_with(".csv") ? "csv" : "wav";
}

/// Assigns the outputs to their formats: one file of each at most.
void sortOutputs(RenderOptions& options) {
    std::map<std::string, std::string> byKind;
    for (const std::string& output : options.outputs) {
        const std::string kind = kindOfOutput(output);
        if (const auto [other, isNew] = byKind.emplace(kind, output); !isNew) {
            throw UsageError("-o " + output + ": -o " + other->second +
                             " is of the same kind; give one .wav, .haptic, .ahap, .hjif, .csv and .json at most");
        }
        if (clipFormatOf(output)) {
            options.clipPaths.push_back(output);
        } else {
            (kind == "json" ? options.parametricPath : kind == "csv" ? options.tablePath : options.outputPath) = output;
        }
    }
}

void requireSoundOptions(const RenderOptions& options) {
    if (options.solver.empty() != !options.steps.has_value()) {
        throw UsageError("--solver and --steps go together; give both, or --quality");
    }
    if (options.quality == "auto") {
        throw UsageError(
            "--quality auto depends on measured times, so that two renders could differ; name a quality of the model");
    }
    if (options.needsFrames() && std::fmod(options.engine.outputRateHz, inference::waveformRateHz) != 0.0) {
        const auto framed = std::ranges::find_if(
            options.outputs, [](const std::string& output) { return kindOfOutput(output) != "wav"; });
        throw UsageError("-o " + *framed + " needs a --rate that is a multiple of 2000 Hz, such as 48000");
    }
}

/// Checks the length first: a WAV file's sizes are 32-bit numbers, and a render can take hours.
void requireRoom(const headless::Scene& scene, std::size_t frames, const RenderOptions& options) {
    const double seconds = static_cast<double>(frames - 1) / scene.updateRateHz + options.engine.tailSeconds;
    const double maximumSeconds = static_cast<double>(maximumWavSamples) / options.engine.outputRateHz;
    if (seconds > maximumSeconds) {
        throw InputError(options.strokePath + ": lasts " + std::to_string(std::llround(seconds)) +
                         " s; a WAV file at this --rate has room for " + std::to_string(std::llround(maximumSeconds)) +
                         " s. Give a lower --rate or a shorter stroke");
    }
}

/// Prints notes about touches that make no sound.
void explainSilence(const RenderOptions& options, const engine::OfflineFigures& figures, std::uint64_t missedTouches,
                    double updateRateHz) {
    const std::string& stroke = options.strokePath;
    if (figures.touches == 0 && missedTouches == 0) {
        note(
            stroke + " never touches a surface of " + options.scenePath +
            ": the output is silent. `haptoflow contact` prints where the tip goes; positions are metres, y up, of the "
            "tip's centre.");
    }
    if (missedTouches > 0) {
        note(stroke + ": " + std::to_string(missedTouches) + " of " + std::to_string(figures.touches + missedTouches) +
             " touches begin and end between two frames and are not rendered: raise the scene's update_rate (" +
             recordings::plainNumber(updateRateHz) + " Hz).");
    }
    if (figures.silentTouches > 0) {
        note(stroke + ": " + std::to_string(figures.silentTouches) + " of " + std::to_string(figures.touches) +
             " touches make no sound: a texture sounds only while the tip slides.");
    }
}

/// What a clip says of the render.
clips::ClipOrigin originOf(const RenderOptions& options, const std::vector<std::string>& labels,
                           const std::string& modelName, const std::string& quality, const model::ModelHeader& header) {
    const auto nameOf = [](const std::string& path) { return std::filesystem::path(path).filename().string(); };
    return {.title = listed(labels),
            .description = nameOf(options.strokePath) + " over " + nameOf(options.scenePath) + "; " +
                           renderedBy(modelName, quality, options.engine.seed, header.provenance.licence),
            .editor = "HaptoFlow " HAPTOFLOW_VERSION,
            .source = nameOf(options.strokePath),
            .tags = labels};
}

void runRender(const RenderOptions& options) {
    requireSoundOptions(options);
    headless::Scene scene = headless::readSceneFile(options.scenePath);
    const headless::Stroke stroke = headless::readStrokeFile(options.strokePath);
    const std::filesystem::path modelPath = findModel(options.modelPath);
    const model::ModelFile model = readModel(modelPath);
    const model::Tier& tier = chooseTier(model, options.quality);
    const inference::SolverSettings solver = chooseSolver(tier, options.solver, options.steps);
    headless::SceneMaterials materials(model, modelPath, options.scenePath);
    std::ranges::for_each(options.materials, [&materials](const std::string& path) { materials.add(path); });
    materials.require(scene);
    const SceneReliefs reliefs(scene, options.scenePath);
    const std::vector<engine::ContactState> surfaces = headless::propertiesOf(
        scene, [&materials](const std::string& name) { return materials.indexOf(name); }, options.scenePath,
        [&reliefs](const headless::SceneSurface& surface) { return reliefs.numberOf(surface); });
    headless::ContactSettings settings;
    headless::useStiffnessOfMaterials(settings, materials);
    headless::ContactTracker tracker(scene, settings);
    const std::size_t frames = headless::frameCount(stroke, scene.updateRateHz, options.strokePath);
    noteLateKeyframes(scene, stroke, options.scenePath);
    requireRoom(scene, frames, options);
    engine::OfflineSettings engineSettings = options.engine;
    engineSettings.delaySeconds = 1e-3 * options.delayMs;
    engineSettings.materials = materials.files();
    if (!options.actuator.empty()) {
        engineSettings.actuator =
            std::make_shared<const effects::ActuatorProfile>(readActuatorProfile(options.actuator));
    }
    const effects::EffectMask effects = requestedEffects(options.effects);
    RenderFiles files(options);
    requireWavName("-o", options.outputPath);
    requireWavName("--waveform", options.waveformPath);
    const auto generator = inference::makeGenerator(openRuntimeFor(std::span(&tier, 1)), model, tier, solver, 1);

    const ProgressBar bar = progressBar("render", options.quiet);
    std::size_t frame = 0;
    const engine::ContactStateSource next = [&]() -> std::optional<engine::TimedContactState> {
        if (frame == frames) {
            return std::nullopt;
        }
        const headless::TipSample tip = headless::frameAt(stroke, scene.updateRateHz, frame);
        ++frame;
        bar(static_cast<double>(frame) / static_cast<double>(frames), {});
        return headless::stateOf(tracker.update(tip), surfaces, effects);
    };
    const engine::OfflineFigures figures = engine::renderOffline(model, *generator, next, engineSettings, files);

    const std::uint64_t allTouches = touchesOfEverySample(scene, stroke, frames, settings);
    const std::uint64_t missedTouches = allTouches - std::min(allTouches, figures.touches);
    const std::filesystem::path wav(options.outputPath.empty() ? options.outputs.front() : options.outputPath);
    const std::vector<ClipFigures> clipFigures =
        files.finish(originOf(options, labelsIn(scene), modelPath.filename().string(), tier.name, model.header()));
    const bool isEuler = tier.kind == model::TierKind::averageVelocity;
    files.complete(renderReport({.name = wav.stem().string(),
                                 .model = modelPath.filename().string(),
                                 .labels = labelsIn(scene),
                                 .wav = wav.filename().string(),
                                 .tier = tier.name,
                                 .solver = !tier.isSolved() ? ""
                                           : isEuler        ? "euler"
                                                            : std::string(model::solverName(solver.kind)),
                                 .steps = solver.steps,
                                 .outputRateHz = options.engine.outputRateHz,
                                 .missedTouches = missedTouches,
                                 .clips = clipFigures},
                                figures));
    explainSilence(options, figures, missedTouches, scene.updateRateHz);
}

}  // namespace

void addRenderCommand(CLI::App& app) {
    CLI::App* command = app.add_subcommand("render", "Render the vibration of a stroke over a scene to WAV");
    const auto options = std::make_shared<RenderOptions>();
    command->add_option("scene", options->scenePath, "SCENE.json: surfaces and their materials")
        ->required()
        ->type_name("SCENE.json");
    command->add_option("--stroke", options->strokePath, "The tip's path: t,x,y,z[,force]")
        ->required()
        ->type_name("STROKE.csv");
    command
        ->add_option(
            "-o,--output", options->outputs,
            "OUT.wav: one channel of 32-bit float; - for standard output. OUT.haptic (Meta, Lofelt), OUT.ahap "
            "(Apple), OUT.hjif (MPEG-I): a clip for other tools, with amplitude, frequency and transients. "
            "OUT.json, OUT.csv: the same every 5 ms, at the perceived intensity of the wave. May be given once "
            "for each")
        ->required()
        ->allow_extra_args(false)
        ->type_name("FILE");
    command->add_option("--model", options->modelPath, "Model file (default: the one shipped)")->type_name("FILE");
    command
        ->add_option("--material", options->materials,
                     "A .haptomaterial file whose name the scene can use like a label; may be given several times")
        ->allow_extra_args(false)
        ->type_name("FILE");
    command->add_option("--quality", options->quality,
                        "A tier of the model, such as draft; `haptoflow inspect` lists them");
    command
        ->add_option("--solver", options->solver,
                     "ODE solver instead of the tier's own; for kinds `flow` and `average-velocity`")
        ->check(CLI::IsMember({"euler", "midpoint", "heun"}));
    command->add_option("--steps", options->steps, "Steps of that solver")->transform(wholeBetween(1, 16, ""));
    command->add_option("--seed", options->engine.seed, "Seed of the noise: equal seeds give equal bytes")
        ->transform(wholeBetween(0, std::numeric_limits<std::uint64_t>::max(), ""))
        ->capture_default_str();
    command->add_option("--rate", options->engine.outputRateHz, "Output rate in Hz")
        ->transform(outputRate())
        ->capture_default_str();
    command
        ->add_option("--lead-ms", options->engine.leadMs,
                     "Time from a contact state to the first sample generated from it")
        ->check(decimalBetween(0.0, 50.0, "ms"))
        ->capture_default_str();
    command->add_option("--full-scale", options->engine.fullScaleMps2, "Acceleration in m/s^2 at +-1 in the WAV")
        ->check(decimalBetween(1.0, 1000.0, "m/s^2"))
        ->capture_default_str();
    command->add_option("--report", options->reportPath, "Write figures of the render as JSON")->type_name("R.json");
    command
        ->add_option(
            "--effects", options->effects,
            "Effects that every surface requests, one or more of texture, impact, edge and none (default: texture); "
            "a surface with a relief has that, too")
        ->delimiter(',')
        ->check(CLI::IsMember({"texture", "impact", "edge", "none"}))
        ->type_name("LIST");
    command
        ->add_option("--actuator", options->actuator,
                     "Compensate for the actuator that plays the output: a profile's file, or flat or voice-coil")
        ->type_name("PROFILE");
    command->add_flag("--listen", options->engine.listens,
                      "Make the output audible on loudspeakers: louder and brighter. Not for actuators");
    command->add_option("--delay-ms", options->delayMs, "Delay of the whole output")
        ->check(decimalBetween(0.0, 500.0, "ms"))
        ->capture_default_str();
    command
        ->add_option("--waveform", options->waveformPath,
                     "Also write the 2 kHz waveform as generated, before level law, resampling and limiter")
        ->type_name("W.wav");
    command->add_flag("--quiet", options->quiet, "No progress bar");
    command->footer(
        "Examples:\n"
        "  haptoflow render scene.json --stroke stroke.csv -o stroke.wav --report stroke.json\n"
        "  haptoflow render scene.json --stroke stroke.csv -o draft.wav --quality draft\n"
        "  haptoflow render scene.json --stroke stroke.csv -o taps.wav --effects texture,impact,edge --actuator "
        "voice-coil\n"
        "  haptoflow render scene.json --stroke stroke.csv -o stroke.haptic -o stroke.ahap --effects texture,impact\n"
        "+-1 in the WAV is 200 m/s^2 (see --full-scale): most textures are quiet, at their true level.");
    command->callback([options] {
        sortOutputs(*options);
        runRender(*options);
    });
}

}  // namespace haptoflow::cli
