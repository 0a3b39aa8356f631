#include "scene_materials.hpp"

#include "command_files.hpp"
#include "engine/material_library.hpp"
#include "exit_codes.hpp"
#include "model/plain_text.hpp"
#include "scene_file.hpp"

#include <algorithm>
#include <optional>
#include <utility>

namespace haptoflow::cli {
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

void SceneMaterials::require(headless::Scene& scene) {
    for (headless::SceneSurface& surface : scene.surfaces) {
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

void useStiffnessOfMaterials(headless::ContactSettings& settings, const SceneMaterials& materials) {
    settings.stiffnessOfLabel = [&materials](std::string_view name) -> std::optional<double> {
        const model::Label* label = materials.find(name);
        return label == nullptr ? std::nullopt : std::optional(label->stiffnessNewtonsPerMetre);
    };
}

}  // namespace haptoflow::cli
