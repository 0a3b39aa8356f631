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

}  // namespace haptoflow::engine
