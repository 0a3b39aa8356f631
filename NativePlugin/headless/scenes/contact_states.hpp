#pragma once

#include "effects/effect.hpp"
#include "engine/contact_state.hpp"
#include "engine/offline_renderer.hpp"
#include "headless/contact_types.hpp"
#include "headless/scene.hpp"

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace haptoflow::headless {

/// The index by which contact states refer to a label or material.
using IndexOfMaterial = std::function<std::uint32_t(const std::string& name)>;

/// A state with the material, feature scale, tone and variation of each surface, in the scene's order. Throws
/// InputError for a blend of too many labels.
[[nodiscard]] std::vector<engine::ContactState> propertiesOf(const Scene& scene, const IndexOfMaterial& indexOf,
                                                             const std::string& sceneName);

/// What a voice is told of a contact: the touched surface's properties, and the reading.
[[nodiscard]] engine::TimedContactState stateOf(const ContactReading& reading,
                                                std::span<const engine::ContactState> surfaces,
                                                effects::EffectMask effects);

}  // namespace haptoflow::headless
