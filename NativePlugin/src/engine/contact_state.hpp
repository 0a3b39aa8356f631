#pragma once

#include "effects/effect.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

namespace haptoflow::engine {

/// A label of the model, or a registered material with an index after the labels, and its weight in a blend.
struct LabelWeight {
    std::uint32_t label = 0;
    float weight = 0.0F;
};

/// The material of a surface: up to four labels with weights. The weights need not add up to 1; negative ones count as
/// 0.
struct MaterialBlend {
    static constexpr std::size_t capacity = 4;
    std::array<LabelWeight, capacity> entries{};
    std::size_t count = 0;
};

/// Contact between the stylus tip and a surface, published once per frame.
struct ContactState {
    double timeSeconds = 0.0;
    bool touching = false;
    /// Increases by 1 at each touch-down, so that a tap shorter than a frame is not lost.
    std::uint32_t touchCounter = 0;
    /// Tangential velocity along the surface's two axes.
    std::array<float, 2> velocityMps{};
    float forceNewtons = 0.0F;
    /// Speed towards the surface at the newest landing.
    float approachSpeedMps = 0.0F;
    MaterialBlend material{};
    /// Effects of the surface: texture, impact, edge. Other bits are ignored.
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

    [[nodiscard]] bool hasEffect(effects::EffectKind kind) const noexcept {
        return (effects & effects::maskOf(kind)) != 0;
    }
};

/// Makes every field finite and clamps it: speeds to +-20 m/s, force to 0-1,000 N, weights to 0-1, edge height to 0-1
/// m, scale to 0.25-4, tilt to +-12 dB/octave. Returns the number of changed fields.
std::uint32_t sanitise(ContactState& state) noexcept;

}  // namespace haptoflow::engine
