#pragma once

#include "headless/scene.hpp"

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace haptoflow::cli {

/// Reads SCENE.json (Documentation~/scene-and-stroke.md). Throws InputError that names the file, the key or the line
/// and column, and the expected content.
[[nodiscard]] headless::Scene readSceneFile(const std::string& path);

/// Reads a scene from its text; `fileName` is its name in errors.
[[nodiscard]] headless::Scene parseSceneText(const std::string& text, const std::string& fileName);

/// Reads a scene from parsed JSON; `fileName` is its name in errors.
[[nodiscard]] headless::Scene parseScene(const nlohmann::json& document, const std::string& fileName);

}  // namespace haptoflow::cli
