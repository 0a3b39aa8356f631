#pragma once

#include <array>
#include <cstddef>
#include <glm/vec3.hpp>

namespace haptoflow::headless {

/// Places at times, and the velocity at the newest of them.
///
/// A parabola is fitted by least squares to the newest places, to as many as agree with it: adaptive windowing of
/// second order (Janabi-Sharifi, Hayward, Chen 2000). The window ends where a cubic would fit better by more than noise
/// explains, which is sooner noticed than a place outside a band. The derivative is taken at the newest place, so that
/// nothing lags; what noise alone can explain of the curvature is left out (James and Stein 1961), so that a tip at
/// rest or in steady motion has no more noise than a straight line gives.
class GrowingFit {
public:
    static constexpr std::size_t capacity = 64;

    /// Newest first; not when full.
    void add(double timeSeconds, const glm::dvec3& placeMetres) noexcept;

    [[nodiscard]] std::size_t count() const noexcept { return count_; }
    [[nodiscard]] bool full() const noexcept { return count_ == capacity; }
    [[nodiscard]] double newestSeconds() const noexcept { return entries_[0].timeSeconds; }
    [[nodiscard]] double oldestSeconds() const noexcept { return entries_[count_ - 1].timeSeconds; }
    [[nodiscard]] const glm::dvec3& oldestMetres() const noexcept { return entries_[count_ - 1].placeMetres; }

    /// m/s, with the noise of a place on each axis; zero with fewer than two places.
    [[nodiscard]] glm::dvec3 endVelocity(double noiseMetres) const noexcept;

    /// m/s, the mean over the last `seconds`, over three places at least; zero with fewer than two places.
    [[nodiscard]] glm::dvec3 meanVelocity(double seconds) const noexcept;

private:
    struct Entry {
        double timeSeconds = 0.0;
        glm::dvec3 placeMetres{0.0};
    };
    struct Fit {
        glm::dvec3 endVelocityMps{0.0};
        bool agrees = true;
    };

    [[nodiscard]] Fit fitNewest(std::size_t size, double noiseMetres) const noexcept;

    std::array<Entry, capacity> entries_{};
    std::size_t count_ = 0;
};

/// How noisy a tracker's places are, from the places themselves.
///
/// A hand moves smoothly over four measurements, so that their third difference is mostly noise. A sudden movement
/// makes it larger for a moment. The estimate therefore follows a low quantile, which such moments hardly change, by
/// small steps (Robbins and Monro 1951).
class TrackerNoise {
public:
    /// On each axis.
    [[nodiscard]] double metres() const noexcept { return metres_; }

    /// Forgets the measurements, not what was learnt from them.
    void restart() noexcept { count_ = 0; }

    /// A new measurement, in the frame after the last one's.
    void add(double timeSeconds, const glm::dvec3& placeMetres) noexcept;

private:
    struct Measurement {
        double timeSeconds = 0.0;
        glm::dvec3 placeMetres{0.0};
    };

    std::array<Measurement, 4> newest_{};
    std::size_t count_ = 0;
    double metres_ = 50e-6;
};

}  // namespace haptoflow::headless
