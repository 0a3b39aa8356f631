#include "headless/shape.hpp"

#include "headless/pose.hpp"

#include <algorithm>
#include <cmath>
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

SurfacePoint belowFace(const Face& face, const glm::dvec3& half, const glm::dvec3& point) {
    SurfacePoint result{point, glm::dvec3(0.0), -depthBelow(face, point, half)};
    result.pointMetres[face.axis] = face.side * half[face.axis];
    result.normal[face.axis] = face.side;
    return result;
}

SurfacePoint insideBox(const glm::dvec3& half, const glm::dvec3& point, const QueryOptions& options) {
    const auto nearestSide = [&](glm::length_t axis) { return Face{axis, point[axis] < 0.0 ? -1.0 : 1.0}; };
    const auto nearer = [&](const Face& one, const Face& other) {
        return depthBelow(other, point, half) < depthBelow(one, point, half) ? other : one;
    };
    if (!options.previousNormal) {
        return belowFace(nearer(nearer(nearestSide(1), nearestSide(0)), nearestSide(2)), half, point);
    }
    const Face kept = faceAlong(*options.previousNormal);
    const bool holds = options.cameFromOutside && depthBelow(kept, point, half) <= heldDepthMetres;
    const Face beside = nearer(nearestSide(kept.axis == 1 ? 0 : 1), nearestSide(kept.axis == 2 ? 0 : 2));
    const Face nearest = holds ? beside : nearer(nearestSide(kept.axis), beside);
    const bool isThinner = holds && half[kept.axis] < half[beside.axis];
    const bool isNear = depthBelow(kept, point, half) <= depthBelow(nearest, point, half) + options.faceMarginMetres;
    return belowFace(isThinner || isNear ? kept : nearest, half, point);
}

/// The held face of a box for a point that went through the box and is `outsideMetres` beyond it.
std::optional<SurfacePoint> throughBox(const glm::dvec3& half, const glm::dvec3& point,
                                       const glm::dvec3& previousNormal, double outsideMetres) {
    const Face kept = faceAlong(previousNormal);
    for (const glm::length_t axis : {0, 1, 2}) {
        if (axis != kept.axis && std::abs(point[axis]) > half[axis]) {
            return std::nullopt;
        }
    }
    const double depth = depthBelow(kept, point, half);
    if (depth <= half[kept.axis] || depth > heldDepthMetres) {
        return std::nullopt;
    }
    SurfacePoint result = belowFace(kept, half, point);
    result.beyondMetres = outsideMetres;
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
    if (options.previousNormal && options.cameFromOutside) {
        if (const auto held = throughBox(half, point, *options.previousNormal, distance)) {
            return *held;
        }
    }
    return {nearest, unitOr(point - nearest, up), distance};
}

/// For sphere and capsule: a ball of `radius` around the nearest point of the shape's core.
SurfacePoint aroundCore(const glm::dvec3& core, double radius, const glm::dvec3& point, const glm::dvec3& fallback,
                        const QueryOptions& options) {
    const glm::dvec3 offset = point - core;
    const double distance = glm::length(offset);
    if (options.previousNormal && options.cameFromOutside) {
        const glm::dvec3& held = *options.previousNormal;
        const double height = glm::dot(offset, held);
        // Near the core and past it the nearest side changes at the slightest movement.
        const bool isPast = height < 0.0 || distance < 0.5 * radius;
        if (isPast && glm::length(offset - height * held) <= radius && radius - height <= heldDepthMetres) {
            return {core + radius * held, held, height - radius, std::max(0.0, distance - radius)};
        }
    }
    const glm::dvec3 normal = distance > 1e-13 * radius ? unitOr(offset, fallback) : fallback;
    return {core + radius * normal, normal, distance - radius};
}

SurfacePoint closestOn(const Sphere& sphere, const glm::dvec3& point, const QueryOptions& options) {
    return aroundCore(glm::dvec3(0.0), sphere.radiusMetres, point, options.previousNormal.value_or(up), options);
}

SurfacePoint closestOn(const Capsule& capsule, const glm::dvec3& point, const QueryOptions& options) {
    const double half = std::max(0.0, 0.5 * capsule.heightMetres - capsule.radiusMetres);
    const glm::dvec3 core(0.0, std::clamp(point.y, -half, half), 0.0);
    glm::dvec3 fallback = half > 0.0 ? glm::dvec3(1.0, 0.0, 0.0) : up;
    if (options.previousNormal) {
        const glm::dvec3& previous = *options.previousNormal;
        fallback = half > 0.0 ? unitOr({previous.x, 0.0, previous.z}, fallback) : previous;
    }
    return aroundCore(core, capsule.radiusMetres, point, fallback, options);
}

SurfacePoint closestOn(const Plane&, const glm::dvec3& point, const QueryOptions&) {
    return {{point.x, 0.0, point.z}, up, point.y};
}

/// The mesh's extent at a point, from one side to the other.
double thickness(const TriangleMesh& mesh, const glm::dvec3& point, const MeshPoint& side) {
    const auto opposite = mesh.closestPointFacing(point, -side.normal);
    return opposite ? side.distanceMetres + opposite->distanceMetres : std::numeric_limits<double>::infinity();
}

/// The face within 45 degrees of the previous normal, for a point straight below it; empty for a point beside it.
std::optional<MeshPoint> heldFace(const TriangleMesh& mesh, const glm::dvec3& point, const glm::dvec3& previousNormal) {
    const auto kept = mesh.closestPointFacing(point, previousNormal);
    return kept && kept->behind && kept->isStraight ? kept : std::nullopt;
}

/// The face of a mesh that a point inside is held by, or another one that is nearer.
MeshPoint heldOrNearer(const TriangleMesh& mesh, const glm::dvec3& point, const MeshPoint& held, MeshPoint nearest,
                       const QueryOptions& options) {
    const auto beside =
        mesh.closestPointFacing(point, held.normal, -TriangleMesh::sameSideCosine, TriangleMesh::sameSideCosine);
    if (options.cameFromOutside && beside && held.distanceMetres <= heldDepthMetres) {
        if (thickness(mesh, point, held) < thickness(mesh, point, *beside)) {
            return held;
        }
        nearest = *beside;
    }
    return held.distanceMetres <= nearest.distanceMetres + options.faceMarginMetres ? held : nearest;
}

std::optional<SurfacePoint> closestOn(const std::shared_ptr<const TriangleMesh>& mesh, const glm::dvec3& point,
                                      const QueryOptions& options) {
    MeshPoint found = mesh->closestPoint(point);
    const double sameSide =
        options.previousNormal ? glm::dot(found.normal, *options.previousNormal) : TriangleMesh::sameSideCosine;
    if (sameSide < TriangleMesh::sameSideCosine) {
        if (const auto held = heldFace(*mesh, point, *options.previousNormal)) {
            if (!found.behind && options.cameFromOutside && sameSide < -TriangleMesh::sameSideCosine &&
                held->distanceMetres <= heldDepthMetres) {
                return SurfacePoint{held->pointMetres, held->normal, -held->distanceMetres, found.distanceMetres};
            }
            found = found.behind ? heldOrNearer(*mesh, point, *held, found, options) : found;
        }
    }
    if (!mesh->isClosed() && found.behind && (found.onRim || found.distanceMetres > options.openMeshDepthMetres)) {
        if (found.onRim || !options.cameFromOutside || !options.previousNormal ||
            found.distanceMetres > heldDepthMetres) {
            return std::nullopt;
        }
        return SurfacePoint{found.pointMetres, found.normal, -found.distanceMetres, found.distanceMetres};
    }
    return SurfacePoint{found.pointMetres, found.normal, found.behind ? -found.distanceMetres : found.distanceMetres};
}

std::optional<SurfaceEntry> entryOf(const Box& box, const glm::dvec3& from, const glm::dvec3& to) {
    const glm::dvec3 half = 0.5 * box.sizeMetres;
    const glm::dvec3 path = to - from;
    double entering = -std::numeric_limits<double>::infinity();
    double leaving = std::numeric_limits<double>::infinity();
    Face face;
    for (const glm::length_t axis : {1, 0, 2}) {
        if (path[axis] == 0.0) {
            if (std::abs(from[axis]) > half[axis]) {
                return std::nullopt;
            }
            continue;
        }
        const double side = path[axis] > 0.0 ? -1.0 : 1.0;
        const double share = (side * half[axis] - from[axis]) / path[axis];
        if (share > entering) {
            entering = share;
            face = {axis, side};
        }
        leaving = std::min(leaving, (-side * half[axis] - from[axis]) / path[axis]);
    }
    if (!(entering >= 0.0 && entering <= 1.0 && entering <= leaving)) {
        return std::nullopt;
    }
    SurfaceEntry entry{from + entering * path, glm::dvec3(0.0), entering};
    entry.pointMetres[face.axis] = face.side * half[face.axis];
    entry.normal[face.axis] = face.side;
    return entry;
}

/// The first share of a path at which it is `radius` away from the origin, coming nearer; infinite if there is none.
/// For vectors in space or across an axis.
double shareAtRadius(const glm::dvec3& from, const glm::dvec3& path, double radius) {
    const double square = glm::dot(path, path);
    const double towards = glm::dot(from, path);
    const double root = towards * towards - square * (glm::dot(from, from) - radius * radius);
    return root < 0.0 || square <= 0.0 ? std::numeric_limits<double>::infinity()
                                       : (-towards - std::sqrt(root)) / square;
}

std::optional<SurfaceEntry> entryOf(const Capsule& capsule, const glm::dvec3& from, const glm::dvec3& to) {
    const double radius = capsule.radiusMetres;
    const double half = std::max(0.0, 0.5 * capsule.heightMetres - radius);
    const glm::dvec3 path = to - from;
    const auto coreAt = [&](const glm::dvec3& point) { return glm::dvec3(0.0, std::clamp(point.y, -half, half), 0.0); };
    if (glm::distance(from, coreAt(from)) < radius) {
        return std::nullopt;
    }
    const glm::dvec3 across(1.0, 0.0, 1.0);
    double first = std::numeric_limits<double>::infinity();
    const double side = shareAtRadius(across * from, across * path, radius);
    if (side >= 0.0 && std::abs(from.y + side * path.y) <= half) {
        first = side;
    }
    for (const double end : {-half, half}) {
        const double share = shareAtRadius(from - glm::dvec3(0.0, end, 0.0), path, radius);
        if (share >= 0.0 && share < first && std::abs(from.y + share * path.y) >= half) {
            first = share;
        }
    }
    if (!(first <= 1.0)) {
        return std::nullopt;
    }
    const glm::dvec3 point = from + first * path;
    return SurfaceEntry{point, unitOr(point - coreAt(point), up), first};
}

std::optional<SurfaceEntry> entryOf(const Sphere& sphere, const glm::dvec3& from, const glm::dvec3& to) {
    return entryOf(Capsule{sphere.radiusMetres, 0.0}, from, to);
}

std::optional<SurfaceEntry> entryOf(const Plane&, const glm::dvec3& from, const glm::dvec3& to) {
    if (from.y < 0.0 || to.y >= 0.0) {
        return std::nullopt;
    }
    const double share = from.y / (from.y - to.y);
    return SurfaceEntry{{from.x + share * (to.x - from.x), 0.0, from.z + share * (to.z - from.z)}, up, share};
}

std::optional<SurfaceEntry> entryOf(const std::shared_ptr<const TriangleMesh>& mesh, const glm::dvec3& from,
                                    const glm::dvec3& to) {
    return mesh->firstCrossing(from, to);
}

}  // namespace

std::optional<SurfacePoint> closestSurfacePoint(const Shape& shape, const glm::dvec3& point,
                                                const QueryOptions& options) {
    return std::visit(
        [&](const auto& known) -> std::optional<SurfacePoint> { return closestOn(known, point, options); }, shape);
}

std::optional<SurfaceEntry> entryInto(const Shape& shape, const glm::dvec3& from, const glm::dvec3& to) {
    return std::visit([&](const auto& known) { return entryOf(known, from, to); }, shape);
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
