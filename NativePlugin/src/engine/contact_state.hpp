#pragma once

#include "effects/effect.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

namespace haptoflow::engine {

/// A label of the model, or a registered material behind the labels, and its share of a blend.
struct LabelWeight {
    std::uint32_t label = 0;
    float weight = 0.0F;
};

/// What a surface feels like: up to four labels. Weights need not sum to one; negative ones count as zero.
struct MaterialBlend {
    static constexpr std::size_t capacity = 4;
    std::array<LabelWeight, capacity> entries{};
    std::size_t count = 0;
};

/// What the stylus does to a surface, as published once a frame.
struct ContactState {
    double timeSeconds = 0.0;
    bool touching = false;
    /// One more at each touch-down: a tap shorter than a frame still shows.
    std::uint32_t touchCounter = 0;
    /// Tangential velocity in the surface's own two axes.
    std::array<float, 2> velocityMps{};
    float forceNewtons = 0.0F;
    /// Speed into the surface, latched at the newest landing.
    float approachSpeedMps = 0.0F;
    MaterialBlend material{};
    /// What the surface asks for: texture, impact, edge. Other bits count for nothing.
    effects::EffectMask effects = effects::maskOf(effects::EffectKind::texture);
    /// One more at each edge that the tip crosses or slides off, and how high the newest is.
    std::uint32_t edgeCounter = 0;
    float edgeHeightMetres = 0.0F;
    /// One more at each landing on another surface or face within a touch.
    std::uint32_t landingCounter = 0;
    /// How much larger the surface's features are than the material's; 0 for 1. Ribs are that much further apart, and
    /// whatever else the network makes of a speed is that of a speed so much lower; the level stays.
    float spatialScale = 1.0F;
    /// Brighter above 0, darker below: a tilt of the spectrum about 150 Hz.
    float toneDbPerOctave = 0.0F;

    [[nodiscard]] bool asksFor(effects::EffectKind kind) const noexcept {
        return (effects & effects::maskOf(kind)) != 0;
    }
};

/// Makes every field finite and physical: speed to 20 m/s, force to 0-1,000 N, weights to 0-1, an edge to 0-1 m, a
/// scale to 0.25-4, a tilt to 12 dB an octave. Returns how many fields had to be changed.
std::uint32_t sanitise(ContactState& state) noexcept;

}  // namespace haptoflow::engine
