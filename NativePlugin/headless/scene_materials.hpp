#pragma once

#include "effects/effect.hpp"
#include "engine/contact_state.hpp"
#include "engine/offline_renderer.hpp"
#include "headless/contact_types.hpp"
#include "headless/scene.hpp"
#include "model/material_file.hpp"
#include "model/model_file.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace haptoflow::headless {

/// The index by which contact states refer to a label or material.
using IndexOfMaterial = std::function<std::uint32_t(const std::string& name)>;

/// The number by which contact states name the relief of a surface, which has one.
using NumberOfRelief = std::function<std::uint32_t(const SceneSurface& surface)>;

/// Lays a relief on the state of a surface, for `stateOf`: along the axes of the tip's velocity, 0 at the origin of the
/// surface's frame. The number 0 takes it away. `sizeMetres`: of one tile.
void layRelief(engine::ContactState& surface, std::uint32_t number, std::array<double, 2> sizeMetres, double share);

/// A state with the material, feature scale, tone, variation and relief of each surface, in the scene's order. Without
/// `numberOf` there is no relief. Throws InputError for a blend of too many labels.
[[nodiscard]] std::vector<engine::ContactState> propertiesOf(const Scene& scene, const IndexOfMaterial& indexOf,
                                                             const std::string& sceneName,
                                                             const NumberOfRelief& numberOf = {});

/// What a voice is told of a contact: the touched surface's properties, and the reading.
[[nodiscard]] engine::TimedContactState stateOf(const ContactReading& reading,
                                                std::span<const engine::ContactState> surfaces,
                                                effects::EffectMask effects);

/// Resolves the material names of a scene: a label of the model, the name of a material file given on the command line,
/// or the path of one, relative to the scene file.
class SceneMaterials {
public:
    /// The model must outlive this.
    SceneMaterials(const model::ModelFile& model, std::filesystem::path modelPath, std::string scenePath);

    /// Adds a material file whose name then counts as a label. Throws InputError if it is not a material file, was
    /// learnt for another model, or has a name that is already used.
    void add(const std::string& path);
    /// Reads the material files that the scene names. Throws InputError for an invalid file, and for an unknown name
    /// with the scene, the surface and the three nearest names.
    /// Spells the names in the scene as model and material files do: case and the form of accents do not matter.
    void require(Scene& scene);

    /// The label or material of this name; null if there is none.
    [[nodiscard]] const model::Label* find(std::string_view name) const;
    /// The index that contact states use. Only for a name that was required.
    [[nodiscard]] std::uint32_t indexOf(const std::string& name) const { return indices_.at(name); }
    /// The material files to be registered, in the order of their indices.
    [[nodiscard]] const std::vector<model::MaterialFile>& files() const noexcept { return files_; }

private:
    /// The name as it is known.
    [[nodiscard]] std::string known(const std::string& name, const std::string& surface);
    [[nodiscard]] const std::string* spelling(const std::string& name) const;
    [[nodiscard]] std::uint32_t read(const std::filesystem::path& path, const std::string& complaint);

    const model::ModelFile& model_;
    std::filesystem::path modelPath_;
    std::string scenePath_;
    std::vector<model::MaterialFile> files_;
    std::map<std::string, std::uint32_t, std::less<>> indices_;
};

/// Sets the stiffness of labels and materials for surfaces without their own; `materials` must outlive the settings.
void useStiffnessOfMaterials(ContactSettings& settings, const SceneMaterials& materials);

}  // namespace haptoflow::headless
