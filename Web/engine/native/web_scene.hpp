#pragma once

#include "engine/contact_state.hpp"
#include "engine/offline_renderer.hpp"
#include "headless/contact_tracker.hpp"
#include "headless/scene.hpp"

#include <cstdint>
#include <functional>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace haptoflow::web {

/// A label or material as scenes know it.
struct KnownMaterial {
    std::uint32_t index = 0;
    double stiffnessNewtonsPerMetre = 0.0;
};
using KnownMaterials = std::map<std::string, KnownMaterial, std::less<>>;

/// A scene whose materials are known, and the states of its surfaces.
struct ResolvedScene {
    headless::Scene scene;
    /// In the scene's order: see headless::propertiesOf.
    std::vector<engine::ContactState> surfaces;
    headless::ContactSettings settings;
};

/// Reads SCENE.json. Throws headless::InputError, also for a material that is not known, with the nearest names.
[[nodiscard]] ResolvedScene resolveScene(const std::string& text, const KnownMaterials& materials);

/// What a scene says of a surface's relief, for scripts: see SceneRelief in haptoflow.d.ts.
[[nodiscard]] nlohmann::json reliefJson(const headless::SceneRelief& relief);

/// headless::stateOf, without the relief unless it is among the effects.
[[nodiscard]] engine::TimedContactState stateOf(const headless::ContactReading& reading, const ResolvedScene& scene,
                                                effects::EffectMask effects);

}  // namespace haptoflow::web
