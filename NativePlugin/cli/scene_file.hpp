#pragma once

#include "headless/scene.hpp"

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace haptoflow::cli {

/// Reads SCENE.json (Documentation~/scene-and-stroke.md). Throws InputError naming the file, the key or the line
/// and column, and what was expected there.
[[nodiscard]] headless::Scene readSceneFile(const std::string& path);

/// The same from JSON already read; `fileName` is what errors call it.
[[nodiscard]] headless::Scene parseScene(const nlohmann::json& document, const std::string& fileName);

}  // namespace haptoflow::cli
