#pragma once

#include "effects/effect.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace haptoflow::engine {

/// The material of a surface: up to four labels of the model, or registered materials with an index after the labels,
/// each with a weight. The weights need not add up to 1; negative ones count as 0.
struct MaterialBlend {
    static constexpr std::size_t capacity = 4;
    std::uint32_t count = 0;
    std::array<std::uint32_t, capacity> labels{};
    std::array<float, capacity> weights{};

    /// Throws std::out_of_range if the blend is full.
    void add(std::uint32_t label, float weight) {
        labels.at(count) = label;
        weights.at(count) = weight;
        ++count;
    }
};

/// Contact between the stylus tip and a surface, published once per frame: haptoflow_contact_state after its
/// struct_size, field by field, so that the C interface converts nothing. haptoflow.h says more of each field.
struct ContactState {
    /// 1 or 0.
    std::uint32_t touching = 0;
    /// Increases by 1 at each touch-down, so that a tap shorter than a frame is not lost.
    std::uint32_t touchCounter = 0;
    MaterialBlend material{};
    /// Tangential velocity along the surface's two axes.
    std::array<float, 2> velocityMps{};
    float forceNewtons = 0.0F;
    /// Speed towards the surface at the newest landing.
    float approachSpeedMps = 0.0F;
    /// Effects of the surface: texture, impact, edge, relief. Other bits are ignored.
    effects::EffectMask effects = effects::maskOf(effects::EffectKind::texture);
    /// Increases by 1 at each edge that the tip crosses or slides off; the height of the newest edge.
    std::uint32_t edgeCounter = 0;
    float edgeHeightMetres = 0.0F;
    /// Increases by 1 at each landing on another surface or face within a touch.
    std::uint32_t landingCounter = 0;
    /// Size of the surface's features relative to the material's; 0 stands for 1. Ribs are further apart by this
    /// factor. The network receives a speed divided by it, while the level stays that of the actual speed.
    float spatialScale = 1.0F;
    /// Tilt of the spectrum about 150 Hz: above 0 brighter, below 0 darker.
    float toneDbPerOctave = 0.0F;
    /// 1 if the place is known.
    std::uint32_t hasPlace = 0;
    /// Names the surface, in this and every other session.
    std::uint32_t surfaceSeed = 0;
    /// The contact point and the axes of the velocity in a frame that moves and turns with the surface.
    std::array<float, 3> placeMetres{};
    std::array<float, 3> firstAxis{};
    std::array<float, 3> secondAxis{};
    /// How much this object differs from the mean of its labels. At 0 all objects of a label are alike; at 1 they
    /// differ as much as the recorded pieces do. surfaceSeed tells the objects apart, whether the place is known or
    /// not.
    float variation = 0.0F;
    /// Number of a map in ReliefTable; 0 for none.
    std::uint32_t relief = 0;
    /// Where the contact point lies in the map, 0 to 1 over it.
    std::array<float, 2> reliefPlace{};
    /// The relief's largest amplitude as a share of the full scale, so that the texture keeps the rest.
    float reliefShare = 0.0F;

    [[nodiscard]] bool hasEffect(effects::EffectKind kind) const noexcept {
        return (effects & effects::maskOf(kind)) != 0;
    }
    /// Speed along the surface.
    [[nodiscard]] float speedMps() const noexcept { return std::hypot(velocityMps[0], velocityMps[1]); }
    /// Whether the tip touches and moves fast enough for a study's signal: 5 mm/s.
    [[nodiscard]] bool isMoving() const noexcept { return touching != 0 && speedMps() >= 0.005F; }
};

/// Whether place and axes can be used: no coordinate is beyond 10 km, and both axes have a length from 0.9 to 1.1.
[[nodiscard]] inline bool hasUsablePlace(const ContactState& state) noexcept {
    const auto isUnit = [](const std::array<float, 3>& axis) {
        return std::abs(std::hypot(axis[0], axis[1], axis[2]) - 1.0F) <= 0.1F;
    };
    return std::ranges::all_of(state.placeMetres, [](float each) { return std::abs(each) <= 1e4F; }) &&
           isUnit(state.firstAxis) && isUnit(state.secondAxis);
}

/// Makes every number finite and clamps it: speeds to +-20 m/s, force to 0-1,000 N, weights to 0-1, edge height to 0-1
/// m, scale to 0.25-4, tilt to +-12 dB/octave, variation to 0-1, the relief's place to +-10^6 and its share to 0-1. A
/// place or axes of no use make the place unknown.
/// Returns the number of changed fields.
inline std::uint32_t sanitise(ContactState& state) noexcept {
    constexpr float maximumMps = 20.0F;
    std::uint32_t changes = 0;
    const auto limit = [&changes](float& value, float lowest, float highest, float ifNotFinite = 0.0F) {
        const float inRange = std::isfinite(value) ? std::clamp(value, lowest, highest) : ifNotFinite;
        if (inRange != value) {
            value = inRange;
            ++changes;
        }
    };
    if (state.material.count > MaterialBlend::capacity) {
        state.material.count = MaterialBlend::capacity;
        ++changes;
    }
    for (std::size_t i = 0; i < state.material.count; ++i) {
        limit(state.material.weights[i], 0.0F, 1.0F);
    }
    limit(state.velocityMps[0], -maximumMps, maximumMps);
    limit(state.velocityMps[1], -maximumMps, maximumMps);
    limit(state.forceNewtons, 0.0F, 1000.0F);
    limit(state.approachSpeedMps, -maximumMps, maximumMps);
    limit(state.edgeHeightMetres, 0.0F, 1.0F);
    if (state.spatialScale == 0.0F) {
        state.spatialScale = 1.0F;
    }
    limit(state.spatialScale, 0.25F, 4.0F, 1.0F);
    limit(state.toneDbPerOctave, -12.0F, 12.0F);
    limit(state.variation, 0.0F, 1.0F);
    constexpr float mostMaps = 1e6F;
    limit(state.reliefPlace[0], -mostMaps, mostMaps);
    limit(state.reliefPlace[1], -mostMaps, mostMaps);
    limit(state.reliefShare, 0.0F, 1.0F);
    if (state.hasPlace != 0 && !hasUsablePlace(state)) {
        state.hasPlace = 0;
        ++changes;
    }
    if (state.hasPlace == 0) {
        state.placeMetres = {};
        state.firstAxis = {};
        state.secondAxis = {};
    }
    return changes;
}

}  // namespace haptoflow::engine
