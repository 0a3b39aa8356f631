#pragma once

#include "headless/bounds_tree.hpp"

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>
#include <optional>
#include <vector>

namespace haptoflow::headless {

/// The point on a mesh nearest to another point.
struct MeshPoint {
    glm::dvec3 pointMetres{0.0};
    /// Unit normal of the front side.
    glm::dvec3 normal{0.0, 1.0, 0.0};
    double distanceMetres = 0.0;
    /// The other point lies inside a closed mesh, or behind an open one.
    bool behind = false;
    /// On an edge that belongs to a single triangle.
    bool onRim = false;
    /// The other point is straight above or below the triangles that were searched, not beside their border.
    bool isStraight = true;
};

/// Where a path first goes into a shape.
struct SurfaceEntry {
    glm::dvec3 pointMetres{0.0};
    /// Outward unit normal of the face.
    glm::dvec3 normal{0.0, 1.0, 0.0};
    /// The part of the path before it, 0 to 1.
    double share = 0.0;
};

/// A triangle mesh, convex or not. The front of a triangle (a, b, c) is the side that (b - a) x (c - a) points to: in
/// Unity's frame the side from which its corners run clockwise. Corners at the same position are joined, so that meshes
/// with split vertices count as closed. A closed mesh that is inside out is turned. Inside and outside are decided by
/// angle-weighted pseudonormals (Baerentzen and Aanaes 2005), which is exact for closed meshes that do not intersect
/// themselves.
class TriangleMesh {
public:
    using Triangle = std::array<std::uint32_t, 3>;

    /// Normals closer than this cosine (45 degrees) count as the same side.
    static constexpr double sameSideCosine = 0.7071;

    /// Vertices are finite and indices in range, as parseScene requires. Triangles without area are skipped; throws
    /// std::invalid_argument if all are.
    TriangleMesh(std::vector<glm::dvec3> vertices, const std::vector<Triangle>& triangles);

    [[nodiscard]] MeshPoint closestPoint(const glm::dvec3& point) const;
    /// The nearest point on triangles whose normals have a cosine to `direction` between the two; empty if there are
    /// none.
    [[nodiscard]] std::optional<MeshPoint> closestPointFacing(const glm::dvec3& point, const glm::dvec3& direction,
                                                              double lowestCosine = sameSideCosine,
                                                              double highestCosine = 2.0) const;
    /// The first triangle that the straight path goes through from its front.
    [[nodiscard]] std::optional<SurfaceEntry> firstCrossing(const glm::dvec3& from, const glm::dvec3& to) const;

    /// Every edge is used equally often in both directions.
    [[nodiscard]] bool isClosed() const noexcept { return closed_; }
    [[nodiscard]] glm::dvec3 boundsCentre() const noexcept;
    [[nodiscard]] double boundsRadius() const noexcept;

private:
    /// For each triangle, the normals that decide the side: of each corner (0 to 2), each edge (3: a-b, 4: b-c, 5: c-a)
    /// and the face (6), and whether the feature lies on the rim.
    struct Sides {
        std::array<glm::dvec3, 7> normals{};
        std::array<bool, 7> rim{};
    };
    struct Nearest {
        double squaredDistance = std::numeric_limits<double>::infinity();
        std::uint32_t triangle = 0;
        std::uint32_t feature = 6;
        glm::dvec3 pointMetres{0.0};
    };

    void joinVertices();
    void keepTrianglesWithArea(const std::vector<Triangle>& triangles);
    void findSides();
    void turnIfInsideOut() noexcept;
    void improve(Nearest& nearest, std::uint32_t triangle, const glm::dvec3& point) const noexcept;
    [[nodiscard]] MeshPoint describe(const Nearest& nearest, const glm::dvec3& point) const noexcept;

    std::vector<glm::dvec3> vertices_;
    std::vector<std::uint32_t> joined_;
    std::vector<Triangle> triangles_;
    std::vector<Sides> sides_;
    Bounds bounds_;
    BoundsTree tree_;
    bool closed_ = false;
};

}  // namespace haptoflow::headless
