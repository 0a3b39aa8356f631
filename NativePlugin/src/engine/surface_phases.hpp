#pragma once

#include "engine/place_track.hpp"
#include "engine/rib_phase.hpp"
#include "engine/seam_statistics.hpp"
#include "inference/gaussian_noise.hpp"
#include "inference/segment_generator.hpp"
#include "inference/surface_noise.hpp"
#include "skeleton/skeleton_layout.hpp"

#include <array>
#include <cstdint>
#include <span>

namespace haptoflow::engine {

/// A smooth random field at one point of a path: its value, and its change over the way of one sample.
struct WanderPoint {
    double value = 0.0;
    double changePerSample = 0.0;
};

/// A smooth random field of RMS 1 over a surface, where `path` begins. The same place has the same value; fields of
/// different keys are independent. It is a sum of twelve plane waves in random directions whose lengths lie within half
/// an octave of `wavelengthMetres`, which must be above 0. Any thread; no allocation.
[[nodiscard]] WanderPoint surfaceWander(std::uint64_t key, double wavelengthMetres,
                                        const inference::SurfacePath& path) noexcept;

/// Slips in a sample of waveform time for the network's motion (m/s along both axes, N); 0 for a material that does not
/// slip. `wander`: by how many deviations the way from slip to slip differs from its mean.
[[nodiscard]] double slipsPerSample(const model::StickSlip& slip, const std::array<float, 3>& motion,
                                    double wander) noexcept;

/// Writes the phase of stick-slip, in turns, and its rate, from turns in a sample, into `phases`.
void setSlips(skeleton::Phases& phases, double cycles, double cyclesPerSample) noexcept;

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
        double cyclesPerSample = 0.0;
    };

    RibTrack ribs_;
    Slips slips_;
    // Of the newest `at`.
    WaveVectors vectors_{};
    RibCycles phase_{};
    RibCycles cyclesPerSample_{};
    Slips slip_{};
};

/// A stream's way over its surface in waveform time: where the tip is, and the phases of the surface's waves there. The
/// callback keeps the one that is played; the worker continues a copy of it. A small value; allocates nothing.
class SurfaceTrack {
public:
    /// A tip that has not reported for this long is not guessed any further.
    static constexpr double maximumSecondsAhead = 0.25;

    SurfaceTrack() noexcept : SurfaceTrack(1, 0) {}
    /// `seed` and `voice` key the surfaces.
    SurfaceTrack(std::uint64_t seed, std::uint32_t voice) noexcept : places_(seed, voice) {}

    /// Begins a stream at a sample, with the phases of its seed if it has one.
    void begin(std::int64_t start, const SeedRibs& seed = {}) noexcept;
    /// Phases of a segment that begins at `start`, a number of seconds after its contact was published.
    [[nodiscard]] skeleton::Phases at(const PublishedContact& contact, const MaterialInputs& material,
                                      std::int64_t start, double secondsAhead) noexcept;
    /// The tip's way during the segment of the newest `at`.
    [[nodiscard]] const SurfaceStretch& stretch() const noexcept { return stretch_; }
    /// The segment of the newest `at`, which began at `start`, will be played.
    void add(std::int64_t start) noexcept;

private:
    PlaceTrack places_;
    SurfacePhases phases_;
    SurfaceStretch stretch_;
};

/// Time from the publishing of a contact to the moment when a sample sounds that lies `samples` behind the first sample
/// of a block; the block began `sincePublishedSeconds` after the publishing.
[[nodiscard]] double secondsAhead(double samples, double readingRate, double sincePublishedSeconds) noexcept;

/// Fills `noise` with the surface's numbers along the path, or with those of `otherwise` where the tip is too slow for
/// them.
void fillNoise(std::uint64_t surface, const inference::SurfacePath& path, const inference::NoiseKey& otherwise,
               std::span<float> noise) noexcept;

}  // namespace haptoflow::engine
