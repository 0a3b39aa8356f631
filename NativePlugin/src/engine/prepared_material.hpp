#pragma once

#include "inference/load_limits.hpp"
#include "inference/prepared_tone.hpp"
#include "inference/segment_generator.hpp"
#include "model/model_header.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace haptoflow::engine {

/// The points of speed, direction and force at which a material's level is tabulated. Tables are interpolated linearly
/// in direction and in the logarithms of speed and force. Immutable.
class LevelGrid {
public:
    static constexpr std::size_t speeds = 10;
    static constexpr std::size_t directions = 8;
    static constexpr std::size_t forces = 8;
    static constexpr std::size_t points = speeds * directions * forces;
    /// Natural logarithm of the RMS in m/s^2 at each point.
    using Table = std::span<const float, points>;

    explicit LevelGrid(const model::ModelHeader& header) noexcept;

    /// vx, vy in m/s and force in N at a point.
    [[nodiscard]] std::array<float, 3> motionOf(std::size_t point) const noexcept;
    /// The table's value at a motion, which is clamped to the grid.
    [[nodiscard]] double at(Table table, const std::array<float, 3>& motion) const noexcept;

private:
    /// An axis with points spaced evenly over the logarithm.
    struct Axis {
        double lowest = 0.0;
        double highest = 0.0;
        [[nodiscard]] double value(double place) const noexcept;
        [[nodiscard]] double place(double value, std::size_t count) const noexcept;
    };

    Axis speed_;
    Axis force_;
};

/// Logarithms of the level graph's levels at the points of the grid for each of `embeddings`, one table after the
/// other. Throws inference::InferenceError, inference::LoadCancelled.
[[nodiscard]] std::vector<float> tabulateLevels(
    const LevelGrid& grid, std::span<const std::span<const float, model::embeddingSize>> embeddings,
    inference::LevelEstimator& estimator, const inference::LoadLimits& limits = {});

/// A recorded waveform that is played at touch-down, with the motion at which it was recorded.
struct Seed {
    std::array<double, 2> velocityMps{};
    double forceNewtons = 0.0;
    std::array<double, 2> ribPhase{};
    /// RMS of the played seed relative to the level.
    float gain = 1.0F;
    std::span<const float, model::seedSamples> samples;
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

}  // namespace haptoflow::engine
