#include "headless/triangle_mesh.hpp"

#include "headless/pose.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <stdexcept>
#include <tuple>
#include <utility>

namespace haptoflow::headless {
namespace {

constexpr std::uint32_t faceFeature = 6;

// Of the angle between a triangle and the mean of it and its neighbour: neighbours that differ by up to 50 degrees are
// one face.
constexpr double creaseCosine = 0.9;

constexpr double everywhere = std::numeric_limits<double>::infinity();

struct OnTriangle {
    glm::dvec3 pointMetres;
    std::uint32_t feature;
};

/// The corner, edge or face of the triangle that is nearest, by the Voronoi regions of its features (Ericson, Real-Time
/// Collision Detection, 5.1.5).
OnTriangle closestOnTriangle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& p) {
    const glm::dvec3 ab = b - a;
    const glm::dvec3 ac = c - a;
    const double abA = glm::dot(ab, p - a);
    const double acA = glm::dot(ac, p - a);
    if (abA <= 0.0 && acA <= 0.0) {
        return {a, 0};
    }
    const double abB = glm::dot(ab, p - b);
    const double acB = glm::dot(ac, p - b);
    if (abB >= 0.0 && acB <= abB) {
        return {b, 1};
    }
    const double areaC = abA * acB - abB * acA;
    if (areaC <= 0.0 && abA >= 0.0 && abB <= 0.0) {
        return {a + ab * (abA / (abA - abB)), 3};
    }
    const double abC = glm::dot(ab, p - c);
    const double acC = glm::dot(ac, p - c);
    if (acC >= 0.0 && abC <= acC) {
        return {c, 2};
    }
    const double areaB = abC * acA - abA * acC;
    if (areaB <= 0.0 && acA >= 0.0 && acC <= 0.0) {
        return {a + ac * (acA / (acA - acC)), 5};
    }
    const double areaA = abB * acC - abC * acB;
    const double alongB = acB - abB;
    const double alongC = abC - acC;
    if (areaA <= 0.0 && alongB >= 0.0 && alongC >= 0.0) {
        return {b + (c - b) * (alongB / (alongB + alongC)), 4};
    }
    const double area = areaA + areaB + areaC;
    return {a + ab * (areaB / area) + ac * (areaC / area), faceFeature};
}

struct Edge {
    int balance = 0;
    int count = 0;
    glm::dvec3 normal{0.0};
};

std::pair<std::uint32_t, std::uint32_t> edgeKey(std::uint32_t from, std::uint32_t to) {
    return {std::min(from, to), std::max(from, to)};
}

}  // namespace

TriangleMesh::TriangleMesh(std::vector<glm::dvec3> vertices, const std::vector<Triangle>& triangles)
    : vertices_(std::move(vertices)) {
    joinVertices();
    keepTrianglesWithArea(triangles);
    findSides();
    turnIfInsideOut();

    std::vector<Bounds> boxes(triangles_.size());
    for (std::size_t index = 0; index < triangles_.size(); ++index) {
        for (const std::uint32_t corner : triangles_[index]) {
            boxes[index].include(vertices_[corner]);
        }
        bounds_.include(boxes[index]);
    }
    tree_ = BoundsTree(boxes);
}

void TriangleMesh::joinVertices() {
    const auto key = [this](std::uint32_t index) {
        const glm::dvec3& vertex = vertices_[index];
        return std::tuple(vertex.x, vertex.y, vertex.z);
    };
    std::vector<std::uint32_t> order(vertices_.size());
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return key(a) != key(b) ? key(a) < key(b) : a < b; });
    joined_.resize(vertices_.size());
    for (std::size_t place = 0; place < order.size(); ++place) {
        const bool same = place > 0 && key(order[place]) == key(order[place - 1]);
        joined_[order[place]] = same ? joined_[order[place - 1]] : order[place];
    }
}

void TriangleMesh::keepTrianglesWithArea(const std::vector<Triangle>& triangles) {
    for (const Triangle& triangle : triangles) {
        Triangle corners{};
        for (std::size_t corner = 0; corner < 3; ++corner) {
            corners[corner] = joined_[triangle[corner]];
        }
        const glm::dvec3 ab = vertices_[corners[1]] - vertices_[corners[0]];
        const glm::dvec3 ac = vertices_[corners[2]] - vertices_[corners[0]];
        // Normals of thinner triangles would be rounding errors.
        const double longest = std::max(glm::dot(ab, ab), glm::dot(ac, ac));
        if (glm::length(glm::cross(ab, ac)) > 1e-12 * longest) {
            triangles_.push_back(corners);
        }
    }
    if (triangles_.empty()) {
        throw std::invalid_argument("no triangle has an area");
    }
}

void TriangleMesh::findSides() {
    std::map<std::pair<std::uint32_t, std::uint32_t>, Edge> edges;
    std::vector<glm::dvec3> cornerNormals(vertices_.size(), glm::dvec3(0.0));
    std::vector<bool> cornerOnRim(vertices_.size(), false);
    sides_.resize(triangles_.size());
    for (std::size_t index = 0; index < triangles_.size(); ++index) {
        const Triangle& corners = triangles_[index];
        const glm::dvec3 normal = unitOr(
            glm::cross(vertices_[corners[1]] - vertices_[corners[0]], vertices_[corners[2]] - vertices_[corners[0]]),
            {0.0, 1.0, 0.0});
        sides_[index].normals[faceFeature] = normal;
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const std::uint32_t here = corners[corner];
            const std::uint32_t next = corners[(corner + 1) % 3];
            const std::uint32_t before = corners[(corner + 2) % 3];
            Edge& edge = edges[edgeKey(here, next)];
            edge.balance += here < next ? 1 : -1;
            ++edge.count;
            edge.normal += normal;
            const glm::dvec3 out = unitOr(vertices_[next] - vertices_[here], normal);
            const glm::dvec3 in = unitOr(vertices_[before] - vertices_[here], normal);
            cornerNormals[here] += normal * std::acos(std::clamp(glm::dot(out, in), -1.0, 1.0));
        }
    }
    closed_ = true;
    for (const auto& [key, edge] : edges) {
        closed_ = closed_ && edge.balance == 0;
        if (edge.count == 1) {
            cornerOnRim[key.first] = true;
            cornerOnRim[key.second] = true;
        }
    }
    for (std::size_t index = 0; index < triangles_.size(); ++index) {
        Sides& sides = sides_[index];
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const std::uint32_t here = triangles_[index][corner];
            const Edge& edge = edges[edgeKey(here, triangles_[index][(corner + 1) % 3])];
            sides.normals[corner] = unitOr(cornerNormals[here], sides.normals[faceFeature]);
            sides.normals[corner + 3] = unitOr(edge.normal, sides.normals[faceFeature]);
            sides.rim[corner] = cornerOnRim[here];
            sides.rim[corner + 3] = edge.count == 1;
        }
    }
}

void TriangleMesh::turnIfInsideOut() noexcept {
    double volume = 0.0;
    for (const Triangle& corners : triangles_) {
        // Relative to a corner, so that the volume of a mesh far from its origin is not lost to rounding.
        const glm::dvec3& origin = vertices_[triangles_[0][0]];
        volume += glm::dot(vertices_[corners[0]] - origin,
                           glm::cross(vertices_[corners[1]] - origin, vertices_[corners[2]] - origin));
    }
    if (!closed_ || volume >= 0.0) {
        return;
    }
    for (Sides& sides : sides_) {
        for (glm::dvec3& normal : sides.normals) {
            normal = -normal;
        }
    }
}

void TriangleMesh::improve(Nearest& nearest, std::uint32_t triangle, const glm::dvec3& point) const noexcept {
    const Triangle& corners = triangles_[triangle];
    const OnTriangle found =
        closestOnTriangle(vertices_[corners[0]], vertices_[corners[1]], vertices_[corners[2]], point);
    const glm::dvec3 offset = point - found.pointMetres;
    const double squared = glm::dot(offset, offset);
    // In a tie the lower index wins, whatever the order of the search.
    if (squared < nearest.squaredDistance || (squared == nearest.squaredDistance && triangle < nearest.triangle)) {
        nearest = {squared, triangle, found.feature, found.pointMetres};
    }
}

MeshPoint TriangleMesh::describe(const Nearest& nearest, const glm::dvec3& point) const noexcept {
    const Sides& sides = sides_[nearest.triangle];
    const glm::dvec3& side = sides.normals[nearest.feature];
    const glm::dvec3 offset = point - nearest.pointMetres;
    MeshPoint result{nearest.pointMetres, side, std::sqrt(nearest.squaredDistance), glm::dot(offset, side) < 0.0,
                     sides.rim[nearest.feature]};
    // At an edge or a corner the surface is rounded: the normal is the direction to the point, unless that is rounding
    // error.
    if (nearest.feature != faceFeature && result.distanceMetres > 1e-9 * boundsRadius()) {
        result.normal = unitOr(result.behind ? -offset : offset, side);
        const glm::dvec3& face = sides.normals[faceFeature];
        const bool isCrease = !result.onRim && glm::dot(side, face) > creaseCosine;
        result.isStraight = isCrease || glm::dot(result.normal, face) > 1.0 - 1e-9;
    }
    return result;
}

MeshPoint TriangleMesh::closestPoint(const glm::dvec3& point) const {
    Nearest nearest;
    tree_.visitNear(point, everywhere, [&](std::uint32_t triangle) {
        improve(nearest, triangle, point);
        return nearest.squaredDistance;
    });
    return describe(nearest, point);
}

std::optional<MeshPoint> TriangleMesh::closestPointFacing(const glm::dvec3& point, const glm::dvec3& direction,
                                                          double lowestCosine, double highestCosine) const {
    Nearest nearest;
    tree_.visitNear(point, everywhere, [&](std::uint32_t triangle) {
        const double cosine = glm::dot(sides_[triangle].normals[faceFeature], direction);
        if (cosine > lowestCosine && cosine < highestCosine) {
            improve(nearest, triangle, point);
        }
        return nearest.squaredDistance;
    });
    if (!std::isfinite(nearest.squaredDistance)) {
        return std::nullopt;
    }
    return describe(nearest, point);
}

std::optional<SurfaceEntry> TriangleMesh::firstCrossing(const glm::dvec3& from, const glm::dvec3& to) const {
    const glm::dvec3 path = to - from;
    // A path along the edge of two triangles goes through one of them.
    const double allowance = 1e-9 * boundsRadius();
    const double within = 0.5 * glm::length(path) + allowance;
    std::optional<SurfaceEntry> first;
    std::uint32_t firstTriangle = 0;
    tree_.visitNear(0.5 * (from + to), within * within, [&](std::uint32_t triangle) {
        const Triangle& corners = triangles_[triangle];
        const glm::dvec3& normal = sides_[triangle].normals[faceFeature];
        const double towards = -glm::dot(path, normal);
        const double height = glm::dot(from - vertices_[corners[0]], normal);
        const double share = height / towards;
        const bool isFirst = !first || share < first->share || (share == first->share && triangle < firstTriangle);
        if (towards > 0.0 && height >= 0.0 && share <= 1.0 && isFirst) {
            const glm::dvec3 point = from + share * path;
            const OnTriangle found =
                closestOnTriangle(vertices_[corners[0]], vertices_[corners[1]], vertices_[corners[2]], point);
            if (glm::distance(point, found.pointMetres) <= allowance) {
                first = SurfaceEntry{point, normal, share};
                firstTriangle = triangle;
            }
        }
        return within * within;
    });
    return first;
}

glm::dvec3 TriangleMesh::boundsCentre() const noexcept {
    return 0.5 * (bounds_.lowest + bounds_.highest);
}

double TriangleMesh::boundsRadius() const noexcept {
    return 0.5 * glm::distance(bounds_.lowest, bounds_.highest);
}

}  // namespace haptoflow::headless
