#pragma once

#include "headless/contact_types.hpp"
#include "headless/scene.hpp"
#include "model/material_file.hpp"
#include "model/model_file.hpp"

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace haptoflow::cli {

/// What a name in a scene stands for: a label of the model, the name of a material file that was given beside the
/// scene, or the path of one, relative to the scene file.
class SceneMaterials {
public:
    /// The model must outlive this.
    SceneMaterials(const model::ModelFile& model, std::filesystem::path modelPath, std::string scenePath);

    /// A material file whose name then counts as a label. Throws InputError: not such a file, learnt for another model,
    /// a name that is taken.
    void add(const std::string& path);
    /// Reads the material files that the scene names. Throws InputError for what is not one, and for a name that
    /// nothing has, with the scene, the surface and the three nearest names.
    void require(const headless::Scene& scene);

    /// Null where nothing has that name.
    [[nodiscard]] const model::Label* find(std::string_view name) const;
    /// As a contact state names it. Only for a name that was required.
    [[nodiscard]] std::uint32_t indexOf(const std::string& name) const { return indices_.at(name); }
    /// Those to be registered, in the order of their indices.
    [[nodiscard]] const std::vector<model::MaterialFile>& files() const noexcept { return files_; }

private:
    void requireKnown(const std::string& name, const std::string& surface);
    [[nodiscard]] std::uint32_t read(const std::filesystem::path& path, const std::string& complaint);

    const model::ModelFile& model_;
    std::filesystem::path modelPath_;
    std::string scenePath_;
    std::vector<model::MaterialFile> files_;
    std::map<std::string, std::uint32_t, std::less<>> indices_;
};

/// Surfaces without a stiffness of their own get that of their labels and materials, which must outlive the settings.
void useStiffnessOfMaterials(headless::ContactSettings& settings, const SceneMaterials& materials);

}  // namespace haptoflow::cli
