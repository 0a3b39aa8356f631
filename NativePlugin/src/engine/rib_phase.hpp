#pragma once

#include "inference/segment_generator.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace haptoflow::engine {

/// For each wave vector of a material, turns along it.
using RibTurns = std::array<double, inference::ribCount>;

/// The ribs of a surface: how many cross a millimetre of way, along each of the surface's two axes.
struct WaveVector {
    float x = 0.0F;
    float y = 0.0F;

    [[nodiscard]] bool isNone() const noexcept { return x == 0.0F && y == 0.0F; }
    friend bool operator==(const WaveVector&, const WaveVector&) = default;
};
using WaveVectors = std::array<WaveVector, inference::ribCount>;

/// The last numbers of an embedding.
[[nodiscard]] WaveVectors waveVectorsOf(std::span<const float, inference::embeddingSize> embedding) noexcept;
void setWaveVectors(std::span<float, inference::embeddingSize> embedding, const WaveVectors& vectors) noexcept;
/// The same wave vectors, each that is among `before` in the slot that it has there.
[[nodiscard]] WaveVectors keepingSlots(const WaveVectors& vectors, const WaveVectors& before) noexcept;
/// For each slot of `vectors` the phase of its wave vector, which may stand in another slot of `from`; that of the same
/// slot where it stands in none.
[[nodiscard]] RibTurns phasesFor(const WaveVectors& vectors, const WaveVectors& from, const RibTurns& phases) noexcept;

/// How far a tip travels along each wave vector of a material in one waveform sample; signed. The wave vectors, in
/// cycles per millimetre, are the last numbers of `embedding`.
[[nodiscard]] RibTurns ribTurnsPerSample(std::span<const float, inference::embeddingSize> embedding, double vxMps,
                                         double vyMps) noexcept;

/// The ribs that a seed crosses: its phase at the first sample that sounds, and how it goes on from there.
struct SeedRibs {
    RibTurns phase{};
    RibTurns turnsPerSample{};
    WaveVectors vectors{};
};

/// How far a tip has travelled along the ribs since its stream began, in waveform time. The way is made of pieces, one
/// for each segment that was sent, of one motion each. Allocates nothing; one thread.
class RibTrack {
public:
    /// A stream begins at that sample with a seed.
    void begin(std::int64_t start, const SeedRibs& seed) noexcept;
    /// The phases of `vectors` at a sample, in turns from 0 to below 1, from the newest piece that begins there or
    /// before.
    [[nodiscard]] std::array<float, inference::ribCount> at(std::int64_t sample,
                                                            const WaveVectors& vectors) const noexcept;
    /// From `start` on the tip goes on like this over ribs of these wave vectors; pieces that began there or later are
    /// taken back.
    void add(std::int64_t start, const WaveVectors& vectors, const RibTurns& turnsPerSample) noexcept;

private:
    struct Piece {
        std::int64_t start = 0;
        RibTurns phase{};
        RibTurns turnsPerSample{};
        WaveVectors vectors{};
    };
    // Only pieces ahead of the read head can be taken back. A timeline reaches 600 samples ahead and hops take 10, so
    // these are enough; beyond them the oldest is forgotten, which no later segment asks for.
    static constexpr std::size_t capacity = 64;

    [[nodiscard]] RibTurns turnsAt(std::int64_t sample, const WaveVectors& vectors) const noexcept;

    // Starts rise from piece to piece.
    std::array<Piece, capacity> pieces_{};
    std::size_t count_ = 1;
};

}  // namespace haptoflow::engine
