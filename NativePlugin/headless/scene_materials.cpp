#include "headless/scene_materials.hpp"

#include "engine/material_library.hpp"
#include "headless/command_files.hpp"
#include "headless/scene_file.hpp"
#include "model/plain_text.hpp"

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>
#include <optional>
#include <utility>

namespace haptoflow::headless {
namespace {

std::array<float, 3> toFloats(const glm::dvec3& vector) {
    return {static_cast<float>(vector.x), static_cast<float>(vector.y), static_cast<float>(vector.z)};
}

}  // namespace

void layRelief(engine::ContactState& surface, std::uint32_t number, std::array<double, 2> sizeMetres, double share) {
    surface.relief = number;
    // Tiles of a metre, which stateOf multiplies by the place.
    surface.reliefPlace = {static_cast<float>(1.0 / sizeMetres[0]), static_cast<float>(1.0 / sizeMetres[1])};
    surface.reliefShare = static_cast<float>(share);
}

std::vector<engine::ContactState> propertiesOf(const Scene& scene, const IndexOfMaterial& indexOf,
                                               const std::string& sceneName, const NumberOfRelief& numberOf) {
    std::vector<engine::ContactState> surfaces;
    for (const SceneSurface& surface : scene.surfaces) {
        if (surface.material.size() > engine::MaterialBlend::capacity) {
            throw InputError(sceneName + ": surface '" + surface.name + "' blends " +
                             std::to_string(surface.material.size()) + " labels; expected at most " +
                             std::to_string(engine::MaterialBlend::capacity));
        }
        engine::ContactState& properties = surfaces.emplace_back();
        properties.spatialScale = static_cast<float>(surface.spatialScale);
        properties.toneDbPerOctave = static_cast<float>(surface.toneDbPerOctave);
        properties.variation = static_cast<float>(surface.variation);
        properties.surfaceSeed = surface.seed;
        if (surface.relief && numberOf) {
            layRelief(properties, numberOf(surface), surface.relief->sizeMetres, surface.relief->share);
        }
        for (const auto& [name, weight] : surface.material) {
            properties.material.add(indexOf(name), static_cast<float>(weight));
        }
    }
    return surfaces;
}

engine::TimedContactState stateOf(const ContactReading& reading, std::span<const engine::ContactState> surfaces,
                                  effects::EffectMask effects) {
    engine::TimedContactState state;
    if (reading.surfaceIndex >= 0) {
        state = {surfaces[static_cast<std::size_t>(reading.surfaceIndex)]};
    }
    state.timeSeconds = reading.timeSeconds;
    state.effects = effects;
    state.touching = reading.touching ? 1 : 0;
    state.touchCounter = reading.touchCounter;
    state.velocityMps = {static_cast<float>(reading.tangentialVelocityMps.x),
                         static_cast<float>(reading.tangentialVelocityMps.y)};
    state.forceNewtons = static_cast<float>(reading.forceNewtons);
    state.approachSpeedMps = static_cast<float>(reading.approachSpeedMps);
    state.landingCounter = reading.landingCounter;
    state.edgeCounter = reading.edgeCounter;
    state.edgeHeightMetres = static_cast<float>(reading.edgeHeightMetres);
    state.hasPlace = state.touching;
    state.placeMetres = toFloats(reading.placeMetres);
    state.firstAxis = toFloats(reading.firstAxis);
    state.secondAxis = toFloats(reading.secondAxis);
    if (state.relief != 0) {
        state.effects |= effects::maskOf(effects::EffectKind::relief);
        // Along the axes, which a flat face keeps.
        state.reliefPlace[0] *= static_cast<float>(glm::dot(reading.placeMetres, reading.firstAxis));
        state.reliefPlace[1] *= static_cast<float>(glm::dot(reading.placeMetres, reading.secondAxis));
    }
    return state;
}

namespace {

constexpr std::string_view materialSuffix = ".haptomaterial";

}  // namespace

SceneMaterials::SceneMaterials(const model::ModelFile& model, std::filesystem::path modelPath, std::string scenePath)
    : model_(model), modelPath_(std::move(modelPath)), scenePath_(std::move(scenePath)) {
    for (const model::Label& label : model.header().labels) {
        indices_.emplace(label.name, static_cast<std::uint32_t>(indices_.size()));
    }
}

std::uint32_t SceneMaterials::read(const std::filesystem::path& path, const std::string& complaint) {
    if (files_.size() == engine::MaterialLibrary::maximumRegistered) {
        throw InputError(complaint + path.string() + ": more than " +
                         std::to_string(engine::MaterialLibrary::maximumRegistered) + " material files");
    }
    claimInput("the material", path);
    try {
        model::MaterialFile material = model::readMaterial(path);
        model::requireSpace(material, model_.header());
        files_.push_back(std::move(material));
    } catch (const model::MaterialError& error) {
        throw InputError(complaint + error.what());
    } catch (const model::MaterialMismatch& error) {
        throw InputError(complaint + path.string() + ": " + error.what());
    }
    return static_cast<std::uint32_t>(model_.header().labels.size() + files_.size() - 1);
}

void SceneMaterials::add(const std::string& path) {
    const std::uint32_t index = read(path, "");
    const std::string& name = files_.back().label.name;
    if (spelling(name) != nullptr || !indices_.emplace(name, index).second) {
        throw InputError(
            path + ": its name is \"" + name +
            "\", which is already that of a label of the model or of another material: change the key \"name\"");
    }
}

void SceneMaterials::require(Scene& scene) {
    for (SceneSurface& surface : scene.surfaces) {
        for (auto& [name, weight] : surface.material) {
            name = known(name, surface.name);
        }
    }
}

const std::string* SceneMaterials::spelling(const std::string& name) const {
    const std::string key = model::labelKey(name);
    const auto found = std::ranges::find_if(indices_, [&](const auto& entry) {
        return !entry.first.ends_with(materialSuffix) && model::labelKey(entry.first) == key;
    });
    return found == indices_.end() ? nullptr : &found->first;
}

std::string SceneMaterials::known(const std::string& name, const std::string& surface) {
    if (indices_.contains(name)) {
        return name;
    }
    if (const std::string* label = spelling(name)) {
        return *label;
    }
    if (name.ends_with(materialSuffix)) {
        const std::filesystem::path path = std::filesystem::path(scenePath_).parent_path() / name;
        indices_.emplace(name, read(path, scenePath_ + ": surface '" + surface + "': "));
        return name;
    }
    std::vector<std::string> names;
    for (const model::Label& label : model_.header().labels) {
        names.push_back(label.name);
    }
    for (const model::MaterialFile& material : files_) {
        names.push_back(material.label.name);
    }
    throw InputError(unknownMaterial(scenePath_, surface, name, names) + " `haptoflow inspect " + modelPath_.string() +
                     "` lists all " + std::to_string(model_.header().labels.size()));
}

const model::Label* SceneMaterials::find(std::string_view name) const {
    const auto found = indices_.find(name);
    if (found == indices_.end()) {
        return nullptr;
    }
    const auto& labels = model_.header().labels;
    return found->second < labels.size() ? &labels[found->second] : &files_[found->second - labels.size()].label;
}

void useStiffnessOfMaterials(ContactSettings& settings, const SceneMaterials& materials) {
    settings.stiffnessOfLabel = [&materials](std::string_view name) -> std::optional<double> {
        const model::Label* label = materials.find(name);
        return label == nullptr ? std::nullopt : std::optional(label->stiffnessNewtonsPerMetre);
    };
}

}  // namespace haptoflow::headless
