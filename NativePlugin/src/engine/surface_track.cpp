#include "engine/surface_track.hpp"

#include "inference/surface_noise.hpp"

#include <algorithm>

namespace haptoflow::engine {
namespace {

// From the noise to the vibration: two samples of the resampler and one of the filters (measured).
constexpr double outputDelaySamples = 3.0;

}  // namespace

void SurfaceTrack::begin(std::int64_t start, const SeedRibs& seed) noexcept {
    phases_.begin(start, seed);
    places_.begin();
}

skeleton::Phases SurfaceTrack::at(const PublishedContact& contact, const MaterialInputs& material, std::int64_t start,
                                  double secondsAhead) noexcept {
    stretch_ = places_.at(contact, start, secondsAhead);
    return phases_.at(start, material.embedding, contact.ranged.motion, material.waves, stretch_);
}

void SurfaceTrack::add(std::int64_t start) noexcept {
    places_.add(start, stretch_);
    phases_.add();
}

double secondsAhead(double samples, double readingRate, double sincePublishedSeconds) noexcept {
    const double fromBlock = (samples + outputDelaySamples) / (inference::waveformRateHz * readingRate);
    return std::clamp(fromBlock + sincePublishedSeconds, 0.0, SurfaceTrack::maximumSecondsAhead);
}

void fillNoise(std::uint64_t surface, const inference::SurfacePath& path, const inference::NoiseKey& otherwise,
               std::span<float> noise) noexcept {
    if (!inference::fillSurfaceNoise(surface, path, noise)) {
        inference::fillStandardNormal(otherwise, noise);
    }
}

}  // namespace haptoflow::engine
