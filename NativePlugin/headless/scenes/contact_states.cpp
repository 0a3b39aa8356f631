#include "headless/scenes/contact_states.hpp"

#include "headless/scenes/command_files.hpp"

#include <array>

namespace haptoflow::headless {
namespace {

std::array<float, 3> toFloats(const glm::dvec3& vector) {
    return {static_cast<float>(vector.x), static_cast<float>(vector.y), static_cast<float>(vector.z)};
}

}  // namespace

std::vector<engine::ContactState> propertiesOf(const Scene& scene, const IndexOfMaterial& indexOf,
                                               const std::string& sceneName) {
    std::vector<engine::ContactState> surfaces;
    for (const SceneSurface& surface : scene.surfaces) {
        if (surface.material.size() > engine::MaterialBlend::capacity) {
            throw InputError(sceneName + ": surface '" + surface.name + "' blends " +
                             std::to_string(surface.material.size()) + " labels; expected at most " +
                             std::to_string(engine::MaterialBlend::capacity));
        }
        engine::ContactState& properties = surfaces.emplace_back();
        properties.spatialScale = static_cast<float>(surface.spatialScale);
        properties.toneDbPerOctave = static_cast<float>(surface.toneDbPerOctave);
        properties.variation = static_cast<float>(surface.variation);
        properties.surfaceSeed = surface.seed;
        for (const auto& [name, weight] : surface.material) {
            properties.material.add(indexOf(name), static_cast<float>(weight));
        }
    }
    return surfaces;
}

engine::TimedContactState stateOf(const ContactReading& reading, std::span<const engine::ContactState> surfaces,
                                  effects::EffectMask effects) {
    engine::TimedContactState state;
    if (reading.surfaceIndex >= 0) {
        state = {surfaces[static_cast<std::size_t>(reading.surfaceIndex)]};
    }
    state.timeSeconds = reading.timeSeconds;
    state.effects = effects;
    state.touching = reading.touching ? 1 : 0;
    state.touchCounter = reading.touchCounter;
    state.velocityMps = {static_cast<float>(reading.tangentialVelocityMps.x),
                         static_cast<float>(reading.tangentialVelocityMps.y)};
    state.forceNewtons = static_cast<float>(reading.forceNewtons);
    state.approachSpeedMps = static_cast<float>(reading.approachSpeedMps);
    state.landingCounter = reading.landingCounter;
    state.edgeCounter = reading.edgeCounter;
    state.edgeHeightMetres = static_cast<float>(reading.edgeHeightMetres);
    state.hasPlace = state.touching;
    state.placeMetres = toFloats(reading.placeMetres);
    state.firstAxis = toFloats(reading.firstAxis);
    state.secondAxis = toFloats(reading.secondAxis);
    return state;
}

}  // namespace haptoflow::headless
