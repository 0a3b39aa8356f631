#include "headless/shape.hpp"

#include "headless/vectors.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

namespace haptoflow::headless {
namespace {

constexpr glm::dvec3 up{0.0, 1.0, 0.0};

struct Face {
    glm::length_t axis = 0;
    double side = 1.0;
};

double depthBelow(const Face& face, const glm::dvec3& point, const glm::dvec3& half) {
    return half[face.axis] - face.side * point[face.axis];
}

Face faceAlong(const glm::dvec3& normal) {
    const glm::dvec3 size = glm::abs(normal);
    Face face;
    if (size.y >= size.x && size.y >= size.z) {
        face.axis = 1;
    } else if (size.z > size.x) {
        face.axis = 2;
    }
    face.side = normal[face.axis] < 0.0 ? -1.0 : 1.0;
    return face;
}

SurfacePoint insideBox(const glm::dvec3& half, const glm::dvec3& point, const QueryOptions& options) {
    Face nearest{1, point.y < 0.0 ? -1.0 : 1.0};
    for (const glm::length_t axis : {0, 2}) {
        const Face candidate{axis, point[axis] < 0.0 ? -1.0 : 1.0};
        if (depthBelow(candidate, point, half) < depthBelow(nearest, point, half)) {
            nearest = candidate;
        }
    }
    if (options.previousNormal) {
        const Face kept = faceAlong(*options.previousNormal);
        const double margin = std::min(options.faceMarginMetres, 0.1 * std::min({half.x, half.y, half.z}));
        if (depthBelow(kept, point, half) <= depthBelow(nearest, point, half) + margin) {
            nearest = kept;
        }
    }
    SurfacePoint result{point, glm::dvec3(0.0), -depthBelow(nearest, point, half)};
    result.pointMetres[nearest.axis] = nearest.side * half[nearest.axis];
    result.normal[nearest.axis] = nearest.side;
    return result;
}

SurfacePoint closestOn(const Box& box, const glm::dvec3& point, const QueryOptions& options) {
    const glm::dvec3 half = 0.5 * box.sizeMetres;
    const glm::dvec3 nearest = glm::clamp(point, -half, half);
    const double distance = glm::distance(point, nearest);
    // Below this distance the direction from the surface to the point is only rounding error.
    const double onSurface = 1e-13 * std::max({half.x, half.y, half.z});
    if (distance <= onSurface) {
        return insideBox(half, nearest, options);
    }
    return {nearest, unitOr(point - nearest, up), distance};
}

/// For sphere and capsule: a ball of `radius` around the nearest point of the shape's core.
SurfacePoint aroundCore(const glm::dvec3& core, double radius, const glm::dvec3& point, const glm::dvec3& fallback) {
    const glm::dvec3 offset = point - core;
    const double distance = glm::length(offset);
    const glm::dvec3 normal = distance > 1e-13 * radius ? unitOr(offset, fallback) : fallback;
    return {core + radius * normal, normal, distance - radius};
}

SurfacePoint closestOn(const Sphere& sphere, const glm::dvec3& point, const QueryOptions& options) {
    return aroundCore(glm::dvec3(0.0), sphere.radiusMetres, point, options.previousNormal.value_or(up));
}

SurfacePoint closestOn(const Capsule& capsule, const glm::dvec3& point, const QueryOptions& options) {
    const double half = std::max(0.0, 0.5 * capsule.heightMetres - capsule.radiusMetres);
    const glm::dvec3 core(0.0, std::clamp(point.y, -half, half), 0.0);
    glm::dvec3 fallback = half > 0.0 ? glm::dvec3(1.0, 0.0, 0.0) : up;
    if (options.previousNormal) {
        const glm::dvec3& previous = *options.previousNormal;
        fallback = half > 0.0 ? unitOr({previous.x, 0.0, previous.z}, fallback) : previous;
    }
    return aroundCore(core, capsule.radiusMetres, point, fallback);
}

SurfacePoint closestOn(const Plane&, const glm::dvec3& point, const QueryOptions&) {
    return {{point.x, 0.0, point.z}, up, point.y};
}

std::optional<SurfacePoint> closestOn(const std::shared_ptr<const TriangleMesh>& mesh, const glm::dvec3& point,
                                      const QueryOptions& options) {
    MeshPoint found = mesh->closestPoint(point);
    if (found.behind && options.previousNormal &&
        glm::dot(found.normal, *options.previousNormal) < TriangleMesh::sameSideCosine) {
        const auto kept = mesh->closestPointFacing(point, *options.previousNormal);
        if (kept && kept->behind && kept->distanceMetres <= found.distanceMetres + options.faceMarginMetres) {
            found = *kept;
        }
    }
    if (!mesh->isClosed() && found.behind && (found.onRim || found.distanceMetres > options.openMeshDepthMetres)) {
        return std::nullopt;
    }
    return SurfacePoint{found.pointMetres, found.normal, found.behind ? -found.distanceMetres : found.distanceMetres};
}

}  // namespace

std::optional<SurfacePoint> closestSurfacePoint(const Shape& shape, const glm::dvec3& point,
                                                const QueryOptions& options) {
    return std::visit(
        [&](const auto& known) -> std::optional<SurfacePoint> { return closestOn(known, point, options); }, shape);
}

BoundingSphere boundingSphere(const Shape& shape) noexcept {
    if (const auto* box = std::get_if<Box>(&shape)) {
        return {glm::dvec3(0.0), 0.5 * glm::length(box->sizeMetres)};
    }
    if (const auto* sphere = std::get_if<Sphere>(&shape)) {
        return {glm::dvec3(0.0), sphere->radiusMetres};
    }
    if (const auto* capsule = std::get_if<Capsule>(&shape)) {
        return {glm::dvec3(0.0), std::max(capsule->radiusMetres, 0.5 * capsule->heightMetres)};
    }
    if (const auto* mesh = std::get_if<std::shared_ptr<const TriangleMesh>>(&shape)) {
        return {(*mesh)->boundsCentre(), (*mesh)->boundsRadius()};
    }
    return {glm::dvec3(0.0), std::numeric_limits<double>::infinity()};
}

}  // namespace haptoflow::headless
