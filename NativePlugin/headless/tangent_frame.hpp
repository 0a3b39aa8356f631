#pragma once

#include <glm/vec3.hpp>

namespace haptoflow::headless {

/// Two unit vectors in the tangent plane, in the object's local frame. The first lies along the grain; first,
/// second and normal stand to each other like Unity's x, y and z: first x second = normal.
struct TangentAxes {
    glm::dvec3 first{1.0, 0.0, 0.0};
    glm::dvec3 second{0.0, 0.0, -1.0};
};

/// The tangent axes of one touch.
///
/// Where the grain lies more than 30 degrees away from the normal, the first axis is the grain's projection on the
/// tangent plane. Nearer to the normal the projection spins and then vanishes, so the axes are carried along the
/// stroke without twist instead (parallel transport), with a smooth change-over between 30 and 20 degrees. Back
/// where the grain counts, carried axes turn towards it no faster than the normal turns (times the projection's own
/// sensitivity) plus `turnRadiansPerSecond`: no frame sees a jump. Within a touch the grain is a line, not an
/// arrow: after crossing its pole the axes keep the sign that they arrived with, since turning them by half a
/// turn would let a stroke along the grain feel like one across it meanwhile. Each new touch starts with the arrow.
class TangentFrame {
public:
    static constexpr double turnRadiansPerSecond = 4.0;

    /// `grain` in the object's local frame; local x where it has no direction.
    explicit TangentFrame(const glm::dvec3& grain) noexcept;

    /// The axes for the next frame of the stroke, `stepSeconds` after the last. A normal that is not of unit length
    /// is normalised; one without direction leaves the axes as they are.
    const TangentAxes& update(const glm::dvec3& normal, double stepSeconds) noexcept;

    /// The next update starts a new touch.
    void reset() noexcept { touching_ = false; }

private:
    [[nodiscard]] glm::dvec3 firstAxisOfNewTouch(const glm::dvec3& normal) const noexcept;
    [[nodiscard]] glm::dvec3 carriedFirstAxis(const glm::dvec3& normal, double stepSeconds) const noexcept;

    glm::dvec3 grain_;
    glm::dvec3 normal_{0.0, 1.0, 0.0};
    TangentAxes axes_;
    bool touching_ = false;
};

}  // namespace haptoflow::headless
