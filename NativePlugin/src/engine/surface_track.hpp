#pragma once

#include "engine/place_track.hpp"
#include "engine/surface_phases.hpp"
#include "inference/gaussian_noise.hpp"
#include "skeleton/skeleton_layout.hpp"

#include <array>
#include <cstdint>
#include <span>

namespace haptoflow::engine {

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
