#pragma once

#include <array>
#include <cstddef>
#include <glm/vec3.hpp>

namespace haptoflow::headless {

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
