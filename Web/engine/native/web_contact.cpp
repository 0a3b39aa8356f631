#include "headless/command_files.hpp"
#include "headless/scene_file.hpp"
#include "headless/scene_materials.hpp"
#include "model/plain_text.hpp"
#include "web_imports.hpp"
#include "web_scene.hpp"
#include "web_text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string_view>

using nlohmann::json;
using namespace haptoflow;
using namespace haptoflow::web;

namespace haptoflow::web {

ResolvedScene resolveScene(const std::string& text, const KnownMaterials& materials) {
    const std::string name = "scene";
    ResolvedScene resolved{.scene = headless::parseSceneText(text, name), .surfaces = {}, .settings = {}};
    for (headless::SceneSurface& surface : resolved.scene.surfaces) {
        for (auto& [material, weight] : surface.material) {
            if (materials.contains(material)) {
                continue;
            }
            const auto same = std::ranges::find_if(materials, [key = model::labelKey(material)](const auto& each) {
                return model::labelKey(each.first) == key;
            });
            if (same != materials.end()) {
                material = same->first;
                continue;
            }
            std::vector<std::string> names;
            std::transform(materials.begin(), materials.end(), std::back_inserter(names),
                           [](const auto& each) { return each.first; });
            throw headless::InputError(headless::unknownMaterial(name, surface.name, material, names));
        }
    }
    resolved.surfaces = headless::propertiesOf(
        resolved.scene, [&materials](const std::string& material) { return materials.at(material).index; }, name);
    resolved.settings.stiffnessOfLabel = [materials](std::string_view material) -> std::optional<double> {
        const auto found = materials.find(material);
        return found == materials.end() ? std::nullopt : std::optional(found->second.stiffnessNewtonsPerMetre);
    };
    return resolved;
}

json reliefJson(const headless::SceneRelief& relief) {
    return {{"image", relief.image},           {"isNormalMap", relief.isNormalMap},
            {"sizeMetres", relief.sizeMetres}, {"depthMetres", relief.depthMetres},
            {"isTiled", relief.isTiled},       {"share", relief.share}};
}

engine::TimedContactState stateOf(const headless::ContactReading& reading, const ResolvedScene& scene,
                                  effects::EffectMask effects) {
    constexpr effects::EffectMask relief = effects::maskOf(effects::EffectKind::relief);
    engine::TimedContactState state = headless::stateOf(reading, scene.surfaces, effects & ~relief);
    if ((effects & relief) == 0) {
        state.effects &= ~relief;
    }
    return state;
}

}  // namespace haptoflow::web

namespace {

struct OpenScene {
    explicit OpenScene(ResolvedScene given) : resolved(std::move(given)), tracker(resolved.scene, resolved.settings) {}

    ResolvedScene resolved;
    headless::ContactTracker tracker;
};

std::vector<std::unique_ptr<OpenScene>> scenes;

OpenScene& sceneAt(int index) {
    if (index < 0 || static_cast<std::size_t>(index) >= scenes.size() ||
        scenes[static_cast<std::size_t>(index)] == nullptr) {
        throw WebError("closed", "the scene is closed");
    }
    return *scenes[static_cast<std::size_t>(index)];
}

KnownMaterials materialsFrom(const json& labels) {
    KnownMaterials materials;
    for (const json& label : labels) {
        materials.emplace(
            label.at("name").get<std::string>(),
            KnownMaterial{label.at("index").get<std::uint32_t>(), label.at("stiffnessNewtonsPerMetre").get<double>()});
    }
    return materials;
}

/// Writes the fields of a state in the order in which hapto_voice_publish reads them.
class FieldWriter {
public:
    explicit FieldWriter(double* next) : next_(next) {}

    template <typename... Numbers>
    void put(Numbers... numbers) {
        (put(static_cast<double>(numbers)), ...);
    }
    void put(double number) { *next_++ = number; }
    template <typename Number, std::size_t Count>
    void putAll(const std::array<Number, Count>& numbers) {
        std::for_each(numbers.begin(), numbers.end(), [this](Number each) { put(static_cast<double>(each)); });
    }
    void putAll(const glm::dvec3& vector) { put(vector.x, vector.y, vector.z); }

private:
    double* next_;
};

void writeState(const engine::ContactState& state, double* fields) {
    FieldWriter out(fields);
    out.put(state.touching, state.touchCounter, state.material.count);
    out.putAll(state.material.labels);
    out.putAll(state.material.weights);
    out.putAll(state.velocityMps);
    out.put(state.forceNewtons, state.approachSpeedMps, state.effects, state.edgeCounter, state.edgeHeightMetres,
            state.landingCounter, state.spatialScale, state.toneDbPerOctave, state.hasPlace, state.surfaceSeed);
    out.putAll(state.placeMetres);
    out.putAll(state.firstAxis);
    out.putAll(state.secondAxis);
    out.put(state.variation, state.relief);
    out.putAll(state.reliefPlace);
    out.put(state.reliefShare);
}

}  // namespace

/// `labels`: the labels of the model and the added materials, as hapto_labels_json writes them.
HAPTO_EXPORT HAPTO_NAMED("hapto_scene_open") int hapto_scene_open(const char* text, const char* labels) {
    return guarded([&] {
        auto scene = std::make_unique<OpenScene>(resolveScene(text, materialsFrom(json::parse(labels))));
        auto free = std::find(scenes.begin(), scenes.end(), nullptr);
        if (free == scenes.end()) {
            free = scenes.insert(free, nullptr);
        }
        *free = std::move(scene);
        return static_cast<int>(free - scenes.begin());
    });
}

HAPTO_EXPORT HAPTO_NAMED("hapto_scene_json") const char* hapto_scene_json(int index) {
    return guardedText([&] {
        const headless::Scene& scene = sceneAt(index).resolved.scene;
        json surfaces = json::array();
        for (const headless::SceneSurface& surface : scene.surfaces) {
            json material = json::object();
            for (const auto& [name, weight] : surface.material) {
                material[name] = weight;
            }
            surfaces.push_back({{"index", surfaces.size()}, {"name", surface.name}, {"material", std::move(material)}});
            if (surface.relief) {
                surfaces.back()["relief"] = reliefJson(*surface.relief);
            }
        }
        return dumped({{"updateRateHz", scene.updateRateHz},
                       {"tipRadiusMetres", scene.tipRadiusMetres},
                       {"surfaces", std::move(surfaces)}});
    });
}

/// `tip`: seconds, x, y, z, 1 if a force was measured, the force, effects. `fields` receives the state, then `reading`
/// the time, the surface (-1 for none), the depth, the contact point and the normal.
HAPTO_EXPORT HAPTO_NAMED("hapto_scene_update") int hapto_scene_update(int index, const double* tip, double* fields,
                                                                      double* reading) {
    return guarded([&] {
        OpenScene& open = sceneAt(index);
        headless::TipSample sample;
        sample.timeSeconds = tip[0];
        sample.positionMetres = {tip[1], tip[2], tip[3]};
        if (tip[4] != 0.0) {
            sample.forceNewtons = tip[5];
        }
        const headless::ContactReading found = open.tracker.update(sample);
        writeState(stateOf(found, open.resolved, static_cast<effects::EffectMask>(tip[6])), fields);
        FieldWriter out(reading);
        out.put(found.timeSeconds, found.surfaceIndex, found.penetrationMetres);
        out.putAll(found.pointMetres);
        out.putAll(found.normal);
        return 0;
    });
}

/// `change`: feature scale, tone, variation; not a number leaves one as it is. `labels` of `count` 0 leave the
/// material.
HAPTO_EXPORT HAPTO_NAMED("hapto_scene_set_surface") int hapto_scene_set_surface(int index, int surface,
                                                                                const double* change, int count,
                                                                                const double* labels,
                                                                                const double* weights) {
    return guarded([&] {
        engine::ContactState& state = sceneAt(index).resolved.surfaces.at(static_cast<std::size_t>(surface));
        float* const targets[] = {&state.spatialScale, &state.toneDbPerOctave, &state.variation};
        for (float* target : targets) {
            *target = std::isnan(*change) ? *target : static_cast<float>(*change);
            ++change;
        }
        if (count > 0) {
            state.material = {};
            for (int entry = 0; entry < count; ++entry) {
                state.material.add(static_cast<std::uint32_t>(labels[entry]), static_cast<float>(weights[entry]));
            }
        }
        return 0;
    });
}

/// `number`: of a relief, which may be that of another memory; 0 for none.
HAPTO_EXPORT HAPTO_NAMED("hapto_scene_set_relief") int hapto_scene_set_relief(int index, int surface,
                                                                              std::uint32_t number, double alongMetres,
                                                                              double acrossMetres, double share) {
    return guarded([&] {
        headless::layRelief(sceneAt(index).resolved.surfaces.at(static_cast<std::size_t>(surface)), number,
                            {alongMetres, acrossMetres}, share);
        return 0;
    });
}

/// `pose` receives the position and the rotation (x, y, z, w) of a surface at a time.
HAPTO_EXPORT HAPTO_NAMED("hapto_scene_pose") int hapto_scene_pose(int index, int surface, double timeSeconds,
                                                                  double* pose) {
    return guarded([&] {
        const headless::Scene& scene = sceneAt(index).resolved.scene;
        const headless::Pose found = scene.surfaces.at(static_cast<std::size_t>(surface)).poseAt(timeSeconds);
        FieldWriter out(pose);
        out.putAll(found.positionMetres);
        out.put(found.rotation.x, found.rotation.y, found.rotation.z, found.rotation.w);
        return 0;
    });
}

HAPTO_EXPORT HAPTO_NAMED("hapto_scene_reset") int hapto_scene_reset(int index) {
    return guarded([&] {
        OpenScene& open = sceneAt(index);
        open.tracker = headless::ContactTracker(open.resolved.scene, open.resolved.settings);
        return 0;
    });
}

HAPTO_EXPORT HAPTO_NAMED("hapto_scene_close") int hapto_scene_close(int index) {
    return guarded([&] {
        (void)sceneAt(index);
        scenes[static_cast<std::size_t>(index)].reset();
        return 0;
    });
}
