#pragma once

#include "headless/scene.hpp"

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

namespace haptoflow::headless {

/// Reads SCENE.json (Documentation~/scene-and-stroke.md). Throws InputError that names the file, the key or the line
/// and column, and the expected content.
[[nodiscard]] Scene readSceneFile(const std::string& path);

/// Reads a scene from its text; `fileName` is its name in errors.
[[nodiscard]] Scene parseSceneText(const std::string& text, const std::string& fileName);

/// Reads a scene from parsed JSON; `fileName` is its name in errors.
[[nodiscard]] Scene parseScene(const nlohmann::json& document, const std::string& fileName);

/// The message for a surface whose material is not among `known`. It suggests the three nearest names.
[[nodiscard]] std::string unknownMaterial(const std::string& fileName, const std::string& surface,
                                          const std::string& material, std::span<const std::string> known);

}  // namespace haptoflow::headless
