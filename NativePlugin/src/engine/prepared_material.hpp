#pragma once

#include "engine/level_grid.hpp"
#include "engine/seed_retrieval.hpp"
#include "inference/prepared_tone.hpp"
#include "model/material_file.hpp"
#include "model/model_file.hpp"

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace haptoflow::engine {

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

}  // namespace haptoflow::engine
