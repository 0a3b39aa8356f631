#pragma once

#include "contact/contact_types.hpp"
#include "contact/scene.hpp"
#include "model/model_file.hpp"

#include <filesystem>
#include <memory>
#include <string>

namespace haptoflow::cli {

/// The model's label of that name. Throws InputError that names scene, surface and the three nearest labels.
[[nodiscard]] const model::Label& labelOf(const model::ModelFile& model, const std::filesystem::path& modelPath,
                                          const std::string& name, const std::string& surface,
                                          const std::string& scenePath);

/// Every label of the scene, as `labelOf`.
void requireKnownLabels(const contact::Scene& scene, const model::ModelFile& model,
                        const std::filesystem::path& modelPath, const std::string& scenePath);

/// Surfaces without a stiffness of their own get that of their labels in the model, which must outlive the settings.
void useStiffnessOfLabels(contact::ContactSettings& settings, const model::ModelFile& model);

}  // namespace haptoflow::cli
