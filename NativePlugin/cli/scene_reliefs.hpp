#pragma once

#include "effects/relief_map.hpp"
#include "headless/scene.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace haptoflow::cli {

/// The map of a surface's relief, of a PNG file with 1 to 16 bits: heights from black (0) to white (the depth), of the
/// mean of its colours, or normals in red (right), green (up) and blue, whose heights then span the depth. Columns lead
/// along the first tangent axis and rows along the second, so that the image is seen from outside as it is drawn.
/// Throws InputError that names the file and the remedy.
[[nodiscard]] effects::ReliefMap readRelief(const headless::SceneRelief& relief, double tipRadiusMetres,
                                            const std::string& scenePath);

/// Reads the reliefs of a scene and keeps them in the process's table as long as it lives.
class SceneReliefs {
public:
    SceneReliefs(const headless::Scene& scene, const std::string& scenePath);
    SceneReliefs(const SceneReliefs&) = delete;
    SceneReliefs& operator=(const SceneReliefs&) = delete;
    ~SceneReliefs();

    /// The number of a surface's relief; the surface is one of the scene's.
    [[nodiscard]] std::uint32_t numberOf(const headless::SceneSurface& surface) const;

private:
    std::vector<std::pair<std::string, std::uint32_t>> numbers_;
};

}  // namespace haptoflow::cli
