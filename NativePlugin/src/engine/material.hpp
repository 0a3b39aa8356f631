#pragma once

#include "dsp/tone_cepstrum.hpp"
#include "engine/material_library.hpp"
#include "engine/rib_phase.hpp"
#include "model/model_file.hpp"

#include <array>
#include <optional>

namespace haptoflow::engine {

/// A blend as the network and the range law take it: weighted means of what the materials say.
struct Material {
    /// Its wave vectors are not means: see assignRibs.
    std::array<float, model::embeddingSize> embedding{};
    double speedLevelExponent = 0.0;
    double forceLevelExponent = 0.0;
    double frequencyExponent = 0.0;
};

/// `before` are the wave vectors of the voice's last material: those that stay keep their slots.
[[nodiscard]] Material resolveMaterial(const Ingredients& ingredients, const WaveVectors& before = {}) noexcept;

/// The wave vectors of a material, one a slot. Those of a blend are whole wave vectors of its materials, the heaviest
/// material's first, as many as there are slots: a mean of two would be ribs of another pitch. One that was there
/// before keeps its slot, so that its phase goes on.
[[nodiscard]] WaveVectors assignRibs(const Ingredients& ingredients, const WaveVectors& before) noexcept;

/// The tone of a blend at a speed, tilted by `tiltDbPerOctave` about 150 Hz; the mean of the materials' gains in dB.
/// Nothing where nobody asks for a tone.
[[nodiscard]] std::optional<dsp::ToneCepstrum> resolveTone(const Ingredients& ingredients, double speedMps,
                                                           double tiltDbPerOctave,
                                                           const dsp::ToneCepstrum& tiltOfOne) noexcept;

/// The cepstrum of a tilt by 1 dB an octave. Allocates.
[[nodiscard]] dsp::ToneCepstrum designTilt();

}  // namespace haptoflow::engine
