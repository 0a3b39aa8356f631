#pragma once

#include "inference/segment_generator.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace haptoflow::engine {

/// A number of turns (rib periods) for each wave vector of a material.
using RibCycles = std::array<double, inference::ribCount>;

/// Spatial frequency of ribs along the surface's two axes, in cycles per millimetre.
struct WaveVector {
    float x = 0.0F;
    float y = 0.0F;

    [[nodiscard]] bool isNone() const noexcept { return x == 0.0F && y == 0.0F; }
    friend bool operator==(const WaveVector&, const WaveVector&) = default;
};
using WaveVectors = std::array<WaveVector, inference::ribCount>;

/// Read and write the wave vectors of an embedding, which are its last numbers.
[[nodiscard]] WaveVectors waveVectorsOf(std::span<const float, inference::embeddingSize> embedding) noexcept;
void setWaveVectors(std::span<float, inference::embeddingSize> embedding, const WaveVectors& vectors) noexcept;
/// Reorders `vectors` so that each wave vector that is also among `before` has the slot that it has there.
[[nodiscard]] WaveVectors keepingSlots(const WaveVectors& vectors, const WaveVectors& before) noexcept;
/// For each slot of `vectors`, the phase of that wave vector in `from`, where it may have another slot. A wave vector
/// that is not in `from` gets the phase of the same slot.
[[nodiscard]] RibCycles phasesFor(const WaveVectors& vectors, const WaveVectors& from,
                                  const RibCycles& phases) noexcept;

/// Signed turns along each wave vector of `embedding` per waveform sample at a velocity.
[[nodiscard]] RibCycles ribCyclesPerSample(std::span<const float, inference::embeddingSize> embedding, double vxMps,
                                           double vyMps) noexcept;

/// Phases as the network takes them: below 1 after rounding, too.
[[nodiscard]] std::array<float, inference::ribCount> toNetwork(const RibCycles& phases) noexcept;

/// Rib phase of a seed at its first audible sample, and its advance per sample.
struct SeedRibs {
    RibCycles phase{};
    RibCycles cyclesPerSample{};
    WaveVectors vectors{};
};

/// Rib phases of a stream in waveform time: those of the newest piece of its path, along which the motion is constant.
/// A small value, which threads hand to each other; allocates nothing.
class RibTrack {
public:
    /// Begins a stream with a seed at the sample `start`.
    void begin(std::int64_t start, const SeedRibs& seed) noexcept;
    /// Phases of `vectors` at a sample, in turns in [0, 1).
    [[nodiscard]] RibCycles at(std::int64_t sample, const WaveVectors& vectors) const noexcept;
    /// The same, drawn towards the phases of a place on the surface, so that the ribs stay where they are: at once for
    /// the first segment of a stream, then by half of the difference and at most a tenth of a turn for each.
    [[nodiscard]] RibCycles at(std::int64_t sample, const WaveVectors& vectors,
                               const std::array<double, 2>& placeMetres) const noexcept;
    /// A piece begins at `start` with these phases there and this advance along these wave vectors.
    void add(std::int64_t start, const WaveVectors& vectors, const RibCycles& phase,
             const RibCycles& cyclesPerSample) noexcept;

private:
    struct Piece {
        std::int64_t start = 0;
        RibCycles phase{};
        RibCycles cyclesPerSample{};
        WaveVectors vectors{};
    };

    Piece piece_;
    // True until the first segment of the stream.
    bool isFirst_ = true;
};

}  // namespace haptoflow::engine
