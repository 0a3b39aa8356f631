#include "scene_labels.hpp"

#include "exit_codes.hpp"
#include "near_words.hpp"

#include <optional>
#include <string_view>
#include <vector>

namespace haptoflow::cli {

const model::Label& labelOf(const model::ModelFile& model, const std::filesystem::path& modelPath,
                            const std::string& name, const std::string& surface, const std::string& scenePath) {
    if (const model::Label* label = model.findLabel(name)) {
        return *label;
    }
    std::vector<std::string> labels;
    for (const model::Label& label : model.header().labels) {
        labels.push_back(label.name);
    }
    constexpr std::size_t namedLabels = 3;
    throw InputError(scenePath + ": surface '" + surface + "' has material '" + name +
                     "', which the model does not know; " + didYouMean(nearestWords(name, labels, namedLabels)) +
                     " `haptoflow inspect " + modelPath.string() + "` lists all " + std::to_string(labels.size()));
}

void requireKnownLabels(const contact::Scene& scene, const model::ModelFile& model,
                        const std::filesystem::path& modelPath, const std::string& scenePath) {
    for (const contact::Surface& surface : scene.surfaces) {
        for (const auto& [name, weight] : surface.material) {
            (void)labelOf(model, modelPath, name, surface.name, scenePath);
        }
    }
}

void useStiffnessOfLabels(contact::ContactSettings& settings, const model::ModelFile& model) {
    settings.stiffnessOfLabel = [&model](std::string_view name) -> std::optional<double> {
        const model::Label* label = model.findLabel(name);
        return label == nullptr ? std::nullopt : std::optional(label->stiffnessNewtonsPerMetre);
    };
}

}  // namespace haptoflow::cli
