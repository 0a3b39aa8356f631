#pragma once

#include "dsp/tone_filter.hpp"
#include "engine/material_library.hpp"
#include "engine/prepared_material.hpp"
#include "model/model_header.hpp"
#include "skeleton/stream.hpp"

#include <array>
#include <optional>
#include <span>

namespace haptoflow::engine {

using skeleton::WaveVectors;

/// Read and write the wave vectors of an embedding, which are its last numbers.
[[nodiscard]] WaveVectors waveVectorsOf(std::span<const float, model::embeddingSize> embedding) noexcept;
void setWaveVectors(std::span<float, model::embeddingSize> embedding, const WaveVectors& vectors) noexcept;
/// Reorders `vectors` so that each wave vector that is also among `before` has the slot that it has there.
[[nodiscard]] WaveVectors keepingSlots(const WaveVectors& vectors, const WaveVectors& before) noexcept;

/// A blend in the form that the network and the range law use: weighted means over its materials.
struct Material {
    /// The wave vectors in it are not means: see assignRibs.
    std::array<float, model::embeddingSize> embedding{};
    double speedLevelExponent = 0.0;
    double forceLevelExponent = 0.0;
    double frequencyExponent = 0.0;
    double impulseGain = 0.0;
};

/// `before` holds the wave vectors of the voice's last material; wave vectors that occur in both keep their slots. Of
/// `object` every ingredient has its own offset, by its weight.
[[nodiscard]] Material resolveMaterial(const Ingredients& ingredients, const WaveVectors& before = {},
                                       ObjectIdentity object = {}) noexcept;

/// The wave vectors of a material or blend, one per slot. A blend takes whole wave vectors of its materials in the
/// order of their weights until all slots are used; a mean of two wave vectors would be ribs with another pitch. A wave
/// vector that is among `before` keeps its slot, so that its phase continues.
[[nodiscard]] WaveVectors assignRibs(const Ingredients& ingredients, const WaveVectors& before) noexcept;

/// The tone of a blend at a speed: the mean of its materials' gains in dB plus a tilt of `tiltDbPerOctave` about 150
/// Hz. Empty if no material has a tone and the tilt is 0.
[[nodiscard]] std::optional<dsp::ToneCepstrum> resolveTone(const Ingredients& ingredients, double speedMps,
                                                           double newtons, double tiltDbPerOctave,
                                                           const dsp::ToneCepstrum& tiltPerDecibel) noexcept;

/// Cepstrum of a tilt of 1 dB/octave. Allocates.
[[nodiscard]] dsp::ToneCepstrum designTilt();

/// A motion clamped to the trained range, with the gain and the reading rate that extend the result beyond it.
struct RangedMotion {
    /// Inputs of the network and of the level: vx, vy in m/s and force in N, inside the trained range.
    std::array<float, 3> motion{};
    std::array<float, 3> levelMotion{};
    /// (v / v_edge)^p (F / F_edge)^q; 1 inside the range.
    double levelGain = 1.0;
    /// Speed at which the waveform is read: min(4, (v / v_edge)^gamma); 1 inside the range.
    double readingRate = 1.0;
};

/// Clamps the motion to the trained range and extends level and frequency beyond it with the label's exponents.
/// Continuous in speed and force; the gain is limited to 16. The network's motion uses the speed divided by
/// `spatialScale`, the level the actual speed.
[[nodiscard]] RangedMotion applyRangeLaw(const model::ModelHeader& header, const Material& material,
                                         const std::array<float, 2>& velocityMps, float forceNewtons,
                                         float spatialScale = 1.0F) noexcept;

/// Source of a segment's level.
struct LevelRequest {
    /// RMS in m/s^2 that replaces the level graph's; empty for the graph's.
    std::optional<float> levelMps2;
    /// Motion input of the level graph, and a gain on its result.
    std::array<float, 3> motion{};
    float gain = 1.0F;
};

/// A single material without its own level uses the level graph. A blend uses the mean of its materials' levels,
/// because the graph's level for a mean of embeddings can lie outside the range of their levels.
[[nodiscard]] LevelRequest requestLevel(const Ingredients& ingredients, const RangedMotion& ranged) noexcept;

}  // namespace haptoflow::engine
