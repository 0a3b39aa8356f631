#pragma once

#include "dsp/tone_cepstrum.hpp"
#include "engine/level_grid.hpp"
#include "engine/seed_retrieval.hpp"
#include "model/material_file.hpp"
#include "model/model_file.hpp"

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace haptoflow::engine {

inline constexpr std::array<float, model::embeddingSize> noEmbedding{};

/// A tone over speed, ready to be mixed. Immutable.
class ToneTable {
public:
    /// Designs a cepstrum for each speed. Allocates.
    explicit ToneTable(const model::ToneTable& table);

    /// Between two speeds the mean of their gains in dB, in the logarithm of speed; at the ends held.
    [[nodiscard]] dsp::ToneCepstrum at(double speedMps) const noexcept;

private:
    std::vector<double> speedsMps_;
    std::vector<dsp::ToneCepstrum> cepstra_;
};

/// What the engine knows of a label of the model or of a registered material, ready for a contact state. Views what it
/// was made of. Immutable.
struct KnownMaterial {
    const model::Label* label = nullptr;
    std::span<const float, model::embeddingSize> embedding = noEmbedding;
    const LevelGrid* grid = nullptr;
    /// What the level graph says; empty where the label has a level of its own.
    std::optional<LevelGrid::Table> graphLevels;
    std::optional<ToneTable> tone;
    std::vector<Seed> seeds;

    /// Natural logarithm of the RMS in m/s^2 before tone at a motion (vx, vy in m/s, force in N) inside the trained
    /// range.
    [[nodiscard]] double logLevel(const std::array<float, 3>& motion) const noexcept;
    /// How the level grows with force beyond the trained range.
    [[nodiscard]] double forceExponent() const noexcept;
};

}  // namespace haptoflow::engine
