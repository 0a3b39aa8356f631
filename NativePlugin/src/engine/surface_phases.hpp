#pragma once

#include "engine/place_track.hpp"
#include "engine/rib_phase.hpp"
#include "engine/wave_statistics.hpp"
#include "inference/segment_generator.hpp"
#include "skeleton/skeleton_layout.hpp"

#include <array>
#include <cstdint>
#include <span>

namespace haptoflow::engine {

/// Slips in a sample of waveform time for the network's motion (m/s along both axes, N); 0 for a material that does not
/// slip. `wander`: by how many deviations the way from slip to slip differs from its mean.
[[nodiscard]] double slipsPerSample(const model::StickSlip& slip, const std::array<float, 3>& motion,
                                    double wander) noexcept;

/// Writes the phase of stick-slip, in turns, and its rate, from turns in a sample, into `phases`.
void setSlips(skeleton::Phases& phases, double turns, double turnsPerSample) noexcept;

/// Phases of the surface's waves along a stream in waveform time: ribs by the way along their wave vectors and by their
/// wander from it, stick-slip by the number of slips so far. A small value, which threads hand to each other; allocates
/// nothing.
class SurfacePhases {
public:
    /// Begins a stream with a seed at the sample `start`.
    void begin(std::int64_t start, const SeedRibs& seed) noexcept;
    /// Phases of a segment that begins at `start`, for the network's motion (m/s along both axes, N).
    [[nodiscard]] skeleton::Phases at(std::int64_t start, std::span<const float, inference::embeddingSize> embedding,
                                      const std::array<float, 3>& motion, const WaveStatistics& statistics,
                                      const SurfaceStretch& stretch) noexcept;
    /// The segment of the newest `at` was sent.
    void add() noexcept;

private:
    struct Slips {
        std::int64_t start = 0;
        double phase = 0.0;
        double turnsPerSample = 0.0;
    };

    RibTrack ribs_;
    Slips slips_;
    // Of the newest `at`.
    WaveVectors vectors_{};
    RibTurns phase_{};
    RibTurns turnsPerSample_{};
    Slips slip_{};
};

}  // namespace haptoflow::engine
