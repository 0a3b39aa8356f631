#pragma once

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

namespace haptoflow::headless {

/// Position in metres and rotation of an object, in Unity's left-handed, y-up frame.
struct Pose {
    glm::dvec3 positionMetres{0.0};
    glm::dquat rotation{1.0, 0.0, 0.0, 0.0};

    [[nodiscard]] glm::dvec3 pointToWorld(const glm::dvec3& local) const noexcept;
    [[nodiscard]] glm::dvec3 pointToLocal(const glm::dvec3& world) const noexcept;
    [[nodiscard]] glm::dvec3 directionToWorld(const glm::dvec3& local) const noexcept;
};

/// The same pose with a unit rotation and usable numbers: an unusable position becomes the origin, an unusable rotation
/// the identity.
[[nodiscard]] Pose sanitised(const Pose& pose) noexcept;

/// Coordinates beyond this, in metres or seconds, are not usable: their squares must stay finite.
inline constexpr double maximumCoordinate = 1e12;

/// True for a finite number of at most `maximumCoordinate`.
[[nodiscard]] bool isUsable(double value) noexcept;
[[nodiscard]] bool isUsable(const glm::dvec3& vector) noexcept;

/// `vector` normalised; `fallback` if it has no direction (zero or not finite). Accurate from 1e-300 to 1e300.
[[nodiscard]] glm::dvec3 unitOr(const glm::dvec3& vector, const glm::dvec3& fallback) noexcept;

/// `rotation` normalised; the identity if it is zero or not finite.
[[nodiscard]] glm::dquat unitRotation(const glm::dquat& rotation) noexcept;

/// A unit vector perpendicular to `unit`; the same for the same input.
[[nodiscard]] glm::dvec3 anyPerpendicular(const glm::dvec3& unit) noexcept;

/// Two unit vectors in the tangent plane, in the object's local frame. The first lies along the grain. First, second
/// and normal have the handedness of Unity's x, y and z: first x second = normal.
struct TangentAxes {
    glm::dvec3 first{1.0, 0.0, 0.0};
    glm::dvec3 second{0.0, 0.0, -1.0};
};

/// The tangent axes of one touch.
///
/// If the grain is more than 30 degrees away from the normal, the first axis is the grain's projection on the tangent
/// plane. Nearer to the normal the projection rotates quickly and then vanishes; there the axes are carried along the
/// stroke without twist (parallel transport), with a smooth transition between 30 and 20 degrees. When the grain
/// applies again, carried axes turn towards it no faster than the normal turns (times the projection's own sensitivity)
/// plus `turnRadiansPerSecond`, so that no frame has a jump. Within a touch the grain has no sign: after the grain's
/// pole the axes keep their direction, because turning them by half a turn would mix motion along and across the grain
/// meanwhile. Each new touch starts with the signed direction.
class TangentFrame {
public:
    static constexpr double turnRadiansPerSecond = 4.0;

    /// `grain` is in the object's local frame; local x is used if it has no direction.
    explicit TangentFrame(const glm::dvec3& grain) noexcept;

    /// The axes for the next frame of the stroke, `stepSeconds` after the last one. A normal that is not of unit length
    /// is normalised; a normal without direction leaves the axes unchanged.
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
