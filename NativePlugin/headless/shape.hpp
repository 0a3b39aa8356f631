#pragma once

#include "headless/triangle_mesh.hpp"

#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <variant>

namespace haptoflow::headless {

/// A box centred on the origin; edge lengths in metres, all above zero.
struct Box {
    glm::dvec3 sizeMetres{1.0};
};

/// A sphere centred on the origin.
struct Sphere {
    double radiusMetres = 0.5;
};

/// A capsule along local y, centred on the origin; the height includes both caps (a height below 2 radius is a sphere).
struct Capsule {
    double radiusMetres = 0.5;
    double heightMetres = 2.0;
};

/// The half space below local y = 0.
struct Plane {};

/// Meshes are shared, because trackers copy scenes; the pointer is never null.
using Shape = std::variant<Box, Sphere, Capsule, Plane, std::shared_ptr<const TriangleMesh>>;

/// The point on a surface nearest to another point, in the shape's local frame.
struct SurfacePoint {
    glm::dvec3 pointMetres{0.0};
    /// Outward unit normal.
    glm::dvec3 normal{0.0, 1.0, 0.0};
    /// Negative inside the material.
    double signedDistanceMetres = 0.0;
    /// For a point that went through the shape: its distance from the shape's far side, or from an open mesh.
    /// `signedDistanceMetres` is then measured from the face that was entered. 0 otherwise.
    double beyondMetres = 0.0;
};

/// A face that was entered is held up to this depth below it.
inline constexpr double heldDepthMetres = 0.05;

/// The face that the point is held by, so that it does not change for the nearest one at every depth.
struct QueryOptions {
    /// Local normal of the face that was entered, or of the previous frame's contact with the same surface. A face that
    /// is nearer by the margin replaces it.
    std::optional<glm::dvec3> previousNormal;
    /// True if the touch began on this surface. The face that was entered is then kept, however deep the point is: the
    /// opposite face never replaces it. A neighbouring face does, except on a plate entered through its broad side,
    /// where the shape is thinner below the kept face than below the neighbour.
    bool cameFromOutside = false;
    /// Inside a shape, another face is used only if it is nearer by this much.
    double faceMarginMetres = 0.0005;
    /// Depth behind an open mesh up to which a point counts as inside.
    double openMeshDepthMetres = 0.005;
};

/// The nearest point of the shape's surface. `point` is in the shape's local frame and usable. The result is finite and
/// has a unit normal, also on an edge, on a corner, in the centre of a sphere and on a capsule's axis (there it is the
/// previous normal, or else one near +y that fits the shape). Empty if there is no surface to touch: behind an open
/// mesh, deeper than its depth or beyond its rim.
[[nodiscard]] std::optional<SurfacePoint> closestSurfacePoint(const Shape& shape, const glm::dvec3& point,
                                                              const QueryOptions& options);

/// Where the straight path between two points first enters the shape from outside, or an open mesh from its front.
/// Both points are in the shape's local frame and usable.
[[nodiscard]] std::optional<SurfaceEntry> entryInto(const Shape& shape, const glm::dvec3& from, const glm::dvec3& to);

/// A sphere around the shape in its local frame; a radius of infinity for the plane.
struct BoundingSphere {
    glm::dvec3 centreMetres{0.0};
    double radiusMetres = 0.0;
};
[[nodiscard]] BoundingSphere boundingSphere(const Shape& shape) noexcept;

}  // namespace haptoflow::headless
