#pragma once

#include "dsp/tone_filter.hpp"
#include "engine/material_library.hpp"
#include "engine/onset_levels.hpp"
#include "engine/rib_phase.hpp"
#include "inference/prepared_tone.hpp"
#include "model/material_file.hpp"
#include "model/model_file.hpp"
#include "model/model_header.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace haptoflow::engine {

/// A recorded waveform that is played at touch-down, with the motion at which it was recorded.
struct Seed {
    std::array<double, 2> velocityMps{};
    double forceNewtons = 0.0;
    std::array<double, 2> ribPhase{};
    /// RMS of the played seed relative to the level.
    float gain = 1.0F;
    std::span<const float, model::seedSamples> samples;
    /// Embedding of the recorded material; the rib phase refers to its wave vectors.
    std::span<const float, model::embeddingSize> embedding;
};

/// The seed recorded at the motion nearest to `motion`, compared by the logarithms of speed and force and by the
/// direction of the line of motion (forwards and backwards are equal). Null if there is none. Source: HaptoFlow,
/// section 4.1 (first previous waveform retrieved from the training recordings).
[[nodiscard]] const Seed* retrieveSeed(std::span<const Seed> seeds, const std::array<float, 3>& motion) noexcept;

inline constexpr std::array<float, model::embeddingSize> noEmbedding{};

/// A label of the model or a registered material, prepared for contact states. Views the data it was made from.
/// Immutable.
struct PreparedMaterial {
    const model::Label* label = nullptr;
    std::span<const float, model::embeddingSize> embedding = noEmbedding;
    /// ModelFile::pieceOffsets; empty for a registered material.
    std::span<const float> pieceOffsets;
    const LevelGrid* grid = nullptr;
    /// The level graph's levels; empty if the label states its own level.
    std::optional<LevelGrid::Table> graphLevels;
    std::optional<inference::PreparedTone> tone;
    std::vector<Seed> seeds;

    /// Natural logarithm of the RMS in m/s^2, before tone, at a motion (vx, vy in m/s, force in N) inside the trained
    /// range.
    [[nodiscard]] double logLevel(const std::array<float, 3>& motion) const noexcept;
    /// Exponent of the level's growth with force beyond the trained range.
    [[nodiscard]] double forceExponent() const noexcept;
};

/// Which object of its labels a surface is: ContactState::surfaceSeed and ContactState::variation.
struct ObjectIdentity {
    std::uint32_t surfaceSeed = 0;
    /// 0 to 1.
    float variation = 0.0F;
};

/// The embedding of a material for one object: the material's own plus an offset drawn by the seed, so that objects
/// have the mean and, at a variation of 1, the covariance of the recorded pieces. With the offsets e_s of S pieces,
/// which add up to zero, that is variation * sum_s n_s e_s / sqrt(S - 1), where n_s are independent numbers of mean 0
/// and variance 1: normal ones, limited so that freaks are rare. The same seed draws the same numbers for every
/// label and on every platform. Wave vectors have no offset; a material without recorded pieces, or with a single
/// one, has none at all.
///
/// Any thread; allocates nothing.
[[nodiscard]] std::array<float, model::embeddingSize> embeddingOf(const PreparedMaterial& material,
                                                                  ObjectIdentity object) noexcept;

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
