#include "commands.hpp"
#include "contact/contact_tracker.hpp"
#include "engine/offline_renderer.hpp"
#include "exit_codes.hpp"
#include "inference/onnx_segment_generator.hpp"
#include "model/model_file.hpp"
#include "model_location.hpp"
#include "progress_bar.hpp"
#include "render_report.hpp"
#include "scene_file.hpp"
#include "stroke_file.hpp"
#include "wav_file.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace haptoflow::cli {
namespace {

struct RenderOptions {
    std::string scenePath;
    std::string strokePath;
    std::string outputPath;
    std::string modelPath;
    std::string quality;
    std::string solver;
    std::optional<int> steps;
    std::string reportPath;
    std::string waveformPath;
    engine::OfflineSettings engine;
    bool quiet = false;
};

const std::map<std::string, inference::SolverKind>& solverNames() {
    static const std::map<std::string, inference::SolverKind> names{{"euler", inference::SolverKind::euler},
                                                                    {"midpoint", inference::SolverKind::midpoint},
                                                                    {"heun", inference::SolverKind::heun}};
    return names;
}

std::string nameOf(inference::SolverKind kind) {
    return std::ranges::find(solverNames(), kind, [](const auto& entry) { return entry.second; })->first;
}

inference::SolverKind kindOf(model::TierSolver solver) {
    switch (solver) {
        case model::TierSolver::euler:
            return inference::SolverKind::euler;
        case model::TierSolver::heun:
            return inference::SolverKind::heun;
        case model::TierSolver::midpoint:
            break;
    }
    return inference::SolverKind::midpoint;
}

std::string labelsOf(const model::ModelHeader& header) {
    std::string names;
    for (const model::Label& label : header.labels) {
        names += (names.empty() ? "" : ", ") + label.name;
    }
    return names;
}

const model::Tier& chooseTier(const model::ModelFile& model, const std::string& quality) {
    if (quality.empty()) {
        return model.header().tiers[model.header().defaultTier];
    }
    if (const model::Tier* tier = model.findTier(quality)) {
        return *tier;
    }
    std::string tiers;
    for (const model::Tier& tier : model.header().tiers) {
        tiers += (tiers.empty() ? "" : ", ") + tier.name;
    }
    throw UsageError("--quality " + quality + ": this model has " + tiers);
}

std::uint32_t labelIndex(const model::ModelFile& model, const std::string& name, const std::string& scenePath,
                         const std::string& surface) {
    const model::Label* label = model.findLabel(name);
    if (label == nullptr) {
        throw InputError(scenePath + ": surface '" + surface + "' has material '" + name +
                         "', which the model does not know; it knows: " + labelsOf(model.header()));
    }
    return static_cast<std::uint32_t>(label - model.header().labels.data());
}

/// The engine's blend of each surface, in the scene's order.
std::vector<engine::MaterialBlend> blendsOf(const contact::Scene& scene, const model::ModelFile& model,
                                            const std::string& scenePath) {
    std::vector<engine::MaterialBlend> blends;
    for (const contact::Surface& surface : scene.surfaces) {
        if (surface.material.size() > engine::MaterialBlend::capacity) {
            throw InputError(scenePath + ": surface '" + surface.name + "' blends " +
                             std::to_string(surface.material.size()) + " labels; expected at most " +
                             std::to_string(engine::MaterialBlend::capacity));
        }
        engine::MaterialBlend blend;
        for (const auto& [name, weight] : surface.material) {
            blend.entries.at(blend.count) = {.label = labelIndex(model, name, scenePath, surface.name),
                                             .weight = static_cast<float>(weight)};
            ++blend.count;
        }
        blends.push_back(blend);
    }
    return blends;
}

std::vector<engine::ContactState> followStroke(const contact::Scene& scene, const Stroke& stroke,
                                               const model::ModelFile& model, const RenderOptions& options) {
    const std::vector<engine::MaterialBlend> blends = blendsOf(scene, model, options.scenePath);
    contact::ContactSettings settings;
    settings.stiffnessOfLabel = [&model](std::string_view name) -> std::optional<double> {
        const model::Label* label = model.findLabel(name);
        return label == nullptr ? std::nullopt : std::optional(label->stiffnessNewtonsPerMetre);
    };
    contact::ContactTracker tracker(scene, settings);
    const std::size_t frames = frameCount(stroke, scene.updateRateHz, options.strokePath);
    std::vector<engine::ContactState> states;
    states.reserve(frames);
    for (std::size_t frame = 0; frame < frames; ++frame) {
        const contact::ContactReading reading = tracker.update(frameAt(stroke, scene.updateRateHz, frame));
        engine::ContactState state;
        state.timeSeconds = reading.timeSeconds;
        state.touching = reading.touching;
        state.touchCounter = reading.touchCounter;
        state.velocityMps = {static_cast<float>(reading.tangentialVelocityMps.x),
                             static_cast<float>(reading.tangentialVelocityMps.y)};
        state.forceNewtons = static_cast<float>(reading.forceNewtons);
        state.approachSpeedMps = static_cast<float>(reading.approachSpeedMps);
        if (reading.surfaceIndex >= 0) {
            state.material = blends[static_cast<std::size_t>(reading.surfaceIndex)];
        }
        states.push_back(state);
    }
    return states;
}

std::vector<std::string> labelsIn(const contact::Scene& scene) {
    std::vector<std::string> labels;
    for (const contact::Surface& surface : scene.surfaces) {
        for (const auto& [name, weight] : surface.material) {
            if (std::ranges::find(labels, name) == labels.end()) {
                labels.push_back(name);
            }
        }
    }
    return labels;
}

void writeOutputs(const RenderOptions& options, const engine::OfflineRender& render, RenderIdentity identity) {
    writeWav(options.outputPath, render.samples, static_cast<int>(std::lround(options.engine.outputRateHz)));
    if (!options.waveformPath.empty()) {
        std::vector<float> waveform = render.waveformMps2;
        std::ranges::for_each(waveform, [&](float& sample) { sample /= options.engine.fullScaleMps2; });
        writeWav(options.waveformPath, waveform, static_cast<int>(inference::waveformRateHz));
    }
    if (!options.reportPath.empty()) {
        const std::filesystem::path wav(options.outputPath);
        identity.name = wav.stem().string();
        identity.wav = wav.filename().string();
        writeRenderReport(options.reportPath, identity, render);
    }
}

void runRender(const RenderOptions& options) {
    if (options.solver.empty() != !options.steps.has_value()) {
        throw UsageError("--solver and --steps go together; give both, or --quality");
    }
    if (options.quality == "auto") {
        throw UsageError(
            "--quality auto measures time and would not render the same twice; name a quality of the model");
    }
    const contact::Scene scene = readSceneFile(options.scenePath);
    const Stroke stroke = readStrokeFile(options.strokePath);
    const std::filesystem::path modelPath = findModel(options.modelPath);
    const model::ModelFile model = readModel(modelPath);
    const model::Tier& tier = chooseTier(model, options.quality);
    inference::SolverSettings solver{.kind = kindOf(tier.solver), .steps = tier.steps};
    if (options.steps) {
        solver = {.kind = solverNames().at(options.solver), .steps = *options.steps};
    }
    const std::vector<engine::ContactState> states = followStroke(scene, stroke, model, options);
    inference::OnnxSegmentGenerator generator(openRuntime(), model, tier.name, solver, 1);
    const engine::OfflineRender render =
        engine::renderOffline(model, generator, states, options.engine,
                              [bar = progressBar("render", options.quiet)](double share) { bar(share, {}); });
    writeOutputs(options, render,
                 {.model = modelPath.filename().string(),
                  .labels = labelsIn(scene),
                  .solver = nameOf(solver.kind),
                  .steps = solver.steps,
                  .outputRateHz = options.engine.outputRateHz});
}

}  // namespace

void addRenderCommand(CLI::App& app, CommandOutcome& outcome) {
    CLI::App* command = app.add_subcommand("render", "Render what a stroke over a scene feels like, to WAV");
    const auto options = std::make_shared<RenderOptions>();
    command->add_option("scene", options->scenePath, "SCENE.json: surfaces and their materials")
        ->required()
        ->type_name("SCENE.json");
    command->add_option("--stroke", options->strokePath, "Where the tip goes: t,x,y,z[,force]")
        ->required()
        ->type_name("STROKE.csv");
    command->add_option("-o,--output", options->outputPath, "The WAV file, one channel of 32-bit float")
        ->required()
        ->type_name("OUT.wav");
    command->add_option("--model", options->modelPath, "Model file (default: the one shipped)")->type_name("FILE");
    CLI::Option* quality =
        command->add_option("--quality", options->quality, "A tier of the model: draft, standard or fine");
    command->add_option("--solver", options->solver, "ODE solver in place of the tier's own")
        ->check(CLI::IsMember({"euler", "midpoint", "heun"}))
        ->excludes(quality);
    command->add_option("--steps", options->steps, "Steps of that solver")->check(CLI::Range(1, 16))->excludes(quality);
    command->add_option("--seed", options->engine.seed, "Key of the noise: the same gives the same bytes")
        ->capture_default_str();
    command->add_option("--rate", options->engine.outputRateHz, "Output rate in Hz")
        ->check(CLI::Range(8000.0, 192000.0))
        ->capture_default_str();
    command->add_option("--lead-ms", options->engine.leadMs, "From a contact state to the first sample made from it")
        ->check(CLI::Range(0.0, 50.0))
        ->capture_default_str();
    command->add_option("--full-scale", options->engine.fullScaleMps2, "Acceleration in m/s^2 that is +-1 in the WAV")
        ->check(CLI::Range(1.0F, 1000.0F))
        ->capture_default_str();
    command->add_option("--report", options->reportPath, "Write figures of the render as JSON")->type_name("R.json");
    command
        ->add_option("--waveform", options->waveformPath,
                     "Also write the 2 kHz waveform as generated, before level law, resampling and limiter")
        ->type_name("W.wav");
    command->add_flag("--quiet", options->quiet, "No progress bar");
    command->footer(
        "Examples:\n"
        "  haptoflow render scene.json --stroke stroke.csv -o felt.wav --report felt.json\n"
        "  haptoflow render scene.json --stroke stroke.csv -o fine.wav --solver midpoint --steps 4\n"
        "+-1 in the WAV is 200 m/s^2 (see --full-scale); most textures are quiet there, and true to each other.");
    command->callback([options, &outcome] {
        runRender(*options);
        outcome.exitCode = exitDone;
    });
}

}  // namespace haptoflow::cli
