#pragma once

#include "headless/triangle_mesh.hpp"

#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <variant>

namespace haptoflow::headless {

/// Centred on the origin; edge lengths in metres, all above zero.
struct Box {
    glm::dvec3 sizeMetres{1.0};
};

/// Centred on the origin.
struct Sphere {
    double radiusMetres = 0.5;
};

/// Along local y, centred on the origin; the height includes both caps (a height below 2 radius is a sphere).
struct Capsule {
    double radiusMetres = 0.5;
    double heightMetres = 2.0;
};

/// Everything below local y = 0.
struct Plane {};

/// Shared, because trackers copy scenes; never null.
using Shape = std::variant<Box, Sphere, Capsule, Plane, std::shared_ptr<const TriangleMesh>>;

/// The place on a surface nearest to a point, in the shape's local frame.
struct SurfacePoint {
    glm::dvec3 pointMetres{0.0};
    /// Unit length, out of the material.
    glm::dvec3 normal{0.0, 1.0, 0.0};
    /// Negative inside the material.
    double signedDistanceMetres = 0.0;
};

/// What a query remembers so that a normal does not flip between two faces that are equally near.
struct QueryOptions {
    /// Local normal of the previous frame's contact with the same surface.
    std::optional<glm::dvec3> previousNormal;
    /// Inside a shape another face takes over only where it is nearer by this much (at most a tenth of a box's
    /// half thickness).
    double faceMarginMetres = 0.0005;
    /// How far behind an open mesh a point still counts as inside it.
    double openMeshDepthMetres = 0.005;
};

/// `point` is in the shape's local frame and usable. Always finite, with a unit normal, also on an edge, a corner,
/// the centre of a sphere or a capsule's axis (there: the previous normal, else +y made to fit the shape).
/// Empty where there is nothing to touch: behind an open mesh, deeper than its depth or past its rim.
[[nodiscard]] std::optional<SurfacePoint> closestSurfacePoint(const Shape& shape, const glm::dvec3& point,
                                                              const QueryOptions& options);

/// A sphere around the shape in its local frame; a radius of infinity for the plane.
struct BoundingSphere {
    glm::dvec3 centreMetres{0.0};
    double radiusMetres = 0.0;
};
[[nodiscard]] BoundingSphere boundingSphere(const Shape& shape) noexcept;

}  // namespace haptoflow::headless
