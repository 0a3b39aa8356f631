#include "capi/handles.hpp"
#include "effects/actuator_profile.hpp"
#include "effects/effect.hpp"
#include "engine/offline_renderer.hpp"
#include "headless/contact_tracker.hpp"
#include "headless/scene_file.hpp"
#include "headless/scene_materials.hpp"
#include "headless/stroke_file.hpp"
#include "inference/random_requests.hpp"
#include "inference/tier_generator.hpp"
#include "model/material_file.hpp"
#include "web_engine.hpp"
#include "web_imports.hpp"
#include "web_scene.hpp"
#include "web_text.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

using nlohmann::json;
using namespace haptoflow;
using namespace haptoflow::web;

namespace {

/// The samples of the last render, until the next.
std::vector<float> samples;

/// A tier whose runs are timed.
struct Measured {
    std::unique_ptr<inference::TierGenerator> generator;
    inference::RandomRequests requests;
};
std::unique_ptr<Measured> measured;

std::shared_ptr<const capi::OpenModel> openModel() {
    return capi::models().get(theModel());
}

const model::Tier& tierOf(const model::ModelFile& model, const std::string& quality) {
    if (quality.empty()) {
        return model.header().tiers[model.header().defaultTier];
    }
    if (const model::Tier* tier = model.findTier(quality)) {
        return *tier;
    }
    std::string names;
    for (const model::Tier& tier : model.header().tiers) {
        names += (names.empty() ? "" : ", ") + tier.name;
    }
    throw WebError("invalid-argument", "quality \"" + quality + "\": this model has " + names);
}

std::unique_ptr<inference::TierGenerator> generatorOf(const capi::OpenModel& open, const std::string& quality) {
    const model::Tier& tier = tierOf(open.model, quality);
    return inference::makeGenerator(capi::runtimes().get(theRuntime()), open.model, tier,
                                    inference::defaultSolver(tier), 1, {}, open.native);
}

/// The labels of the model, then the materials.
KnownMaterials knownMaterials(const model::ModelHeader& header, const std::vector<model::MaterialFile>& materials) {
    KnownMaterials known;
    const auto add = [&known](const model::Label& label) {
        const auto index = static_cast<std::uint32_t>(known.size());
        if (!known.emplace(label.name, KnownMaterial{index, label.stiffnessNewtonsPerMetre}).second) {
            throw WebError("invalid-argument", "two materials are called \"" + label.name + '"');
        }
    };
    std::for_each(header.labels.begin(), header.labels.end(), add);
    std::for_each(materials.begin(), materials.end(), [&add](const auto& material) { add(material.label); });
    return known;
}

effects::EffectMask effectsOf(const json& options) {
    effects::EffectMask mask = 0;
    const std::pair<const char*, effects::EffectKind> kinds[] = {{"texture", effects::EffectKind::texture},
                                                                 {"impact", effects::EffectKind::impact},
                                                                 {"edge", effects::EffectKind::edge}};
    for (const auto& [name, kind] : kinds) {
        mask |= options.at("effects").value(name, false) ? effects::maskOf(kind) : 0U;
    }
    // As at the command line: where a surface has one.
    return options.at("effects").value("relief", true) ? mask | effects::maskOf(effects::EffectKind::relief) : mask;
}

void layReliefs(const json& reliefs, ResolvedScene& resolved) {
    for (const json& relief : reliefs) {
        const auto name = relief.at("surface").get<std::string>();
        const auto& surfaces = resolved.scene.surfaces;
        const auto found = std::ranges::find(surfaces, name, &headless::SceneSurface::name);
        if (found == surfaces.end()) {
            throw WebError("invalid-argument", "reliefs: the scene has no surface \"" + name + '"');
        }
        headless::layRelief(resolved.surfaces[static_cast<std::size_t>(found - surfaces.begin())],
                            relief.at("number").get<std::uint32_t>(),
                            {relief.at("along").get<double>(), relief.at("across").get<double>()},
                            relief.at("share").get<double>());
    }
}

engine::OfflineSettings settingsOf(const json& options, const model::ModelHeader& header) {
    engine::OfflineSettings settings;
    settings.outputRateHz = options.at("rateHz").get<double>();
    settings.leadMs = options.at("leadMs").get<double>();
    settings.seed = options.at("seed").get<std::uint64_t>();
    settings.fullScaleMps2 = options.at("fullScaleMps2").get<float>();
    settings.listens = options.at("listen").get<bool>();
    settings.delaySeconds = options.at("delaySeconds").get<double>();
    const auto actuator = options.at("actuator").get<std::string>();
    if (!actuator.empty()) {
        const auto builtIn = effects::ActuatorProfile::builtIn(actuator);
        settings.actuator = std::make_shared<const effects::ActuatorProfile>(
            builtIn ? *builtIn : effects::ActuatorProfile::parse(actuator));
    }
    for (const json& text : options.at("materials")) {
        model::MaterialFile material = model::parseMaterial(text.get<std::string>());
        model::requireSpace(material, header);
        settings.materials.push_back(std::move(material));
    }
    return settings;
}

class MemorySink final : public engine::OfflineSink {
public:
    void output(std::span<const float> more) override { samples.insert(samples.end(), more.begin(), more.end()); }
    void waveform(std::span<const float> /*samplesMps2*/) override {}
};

std::string render(const json& options) {
    const auto open = openModel();
    const model::ModelHeader& header = open->model.header();
    const engine::OfflineSettings settings = settingsOf(options, header);
    ResolvedScene resolved =
        resolveScene(options.at("scene").get<std::string>(), knownMaterials(header, settings.materials));
    layReliefs(options.at("reliefs"), resolved);
    const std::string name = "stroke";
    const auto text = options.at("stroke").get<std::string>();
    const headless::Stroke stroke = headless::parseStroke(text, name);
    const auto quality = options.at("quality").get<std::string>();
    const auto generator = generatorOf(*open, quality);
    const effects::EffectMask effects = effectsOf(options);
    headless::ContactTracker tracker(resolved.scene, resolved.settings);
    const std::size_t frames = headless::frameCount(stroke, resolved.scene.updateRateHz, name);
    std::size_t frame = 0;
    const engine::ContactStateSource next = [&]() -> std::optional<engine::TimedContactState> {
        if (frame == frames) {
            return std::nullopt;
        }
        const headless::TipSample tip = headless::frameAt(stroke, resolved.scene.updateRateHz, frame);
        ++frame;
        constexpr std::size_t framesPerReport = 64;
        if (frame % framesPerReport == 0) {
            hapto_progress(static_cast<double>(frame) / static_cast<double>(frames), "rendering");
        }
        return stateOf(tracker.update(tip), resolved, effects);
    };
    samples.clear();
    MemorySink sink;
    const engine::OfflineFigures figures = engine::renderOffline(open->model, *generator, next, settings, sink);
    return dumped({{"rateHz", settings.outputRateHz},
                   {"tier", tierOf(open->model, quality).name},
                   {"seconds", static_cast<double>(samples.size()) / settings.outputRateHz},
                   {"touches", figures.touches},
                   {"silentTouches", figures.silentTouches},
                   {"segments", figures.segments},
                   {"inferenceMsMedian", figures.inferenceMsMedian},
                   {"inferenceMsP99", figures.inferenceMsP99}});
}

}  // namespace

/// JSON of the tip's radius, and of each surface of SCENE.json that has a relief.
HAPTO_EXPORT HAPTO_NAMED("hapto_scene_reliefs") const char* hapto_scene_reliefs(const char* text) {
    return guardedText([&] {
        const headless::Scene scene = headless::parseSceneText(text, "scene");
        json reliefs = json::array();
        for (std::size_t index = 0; index < scene.surfaces.size(); ++index) {
            const headless::SceneSurface& surface = scene.surfaces[index];
            if (surface.relief) {
                reliefs.push_back(
                    {{"index", index}, {"surface", surface.name}, {"relief", reliefJson(*surface.relief)}});
            }
        }
        return dumped({{"tipRadiusMetres", scene.tipRadiusMetres}, {"reliefs", std::move(reliefs)}});
    });
}

/// Renders by options as JSON (offline.mjs) into hapto_samples. Returns JSON of figures.
HAPTO_EXPORT HAPTO_NAMED("hapto_render") const char* hapto_render(const char* options) {
    return guardedText([&] { return render(json::parse(options)); });
}

HAPTO_EXPORT HAPTO_NAMED("hapto_samples") const float* hapto_samples() {
    return samples.data();
}

HAPTO_EXPORT HAPTO_NAMED("hapto_sample_count") std::uint32_t hapto_sample_count() {
    return static_cast<std::uint32_t>(samples.size());
}

/// Loads a tier for hapto_measure_segment.
HAPTO_EXPORT HAPTO_NAMED("hapto_measure_load") int hapto_measure_load(const char* tier) {
    return guarded([&] {
        const auto open = openModel();
        measured = std::make_unique<Measured>(
            Measured{generatorOf(*open, tier), inference::RandomRequests(open->model, inference::requestCount, 1)});
        return 0;
    });
}

/// Generates one segment of one voice: the requests, and their order, are those of `haptoflow bench`.
HAPTO_EXPORT HAPTO_NAMED("hapto_measure_segment") int hapto_measure_segment() {
    return guarded([] {
        if (measured == nullptr) {
            throw WebError("closed", "no tier is loaded to be measured");
        }
        std::array<float, inference::segmentSamples> generated{};
        measured->generator->generate(measured->requests.next(1), generated);
        return 0;
    });
}
