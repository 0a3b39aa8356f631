#pragma once

#include "headless/contact_tracker.hpp"
#include "headless/scene.hpp"

#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

namespace haptoflow::headless::testing {

inline constexpr double nan = std::numeric_limits<double>::quiet_NaN();
inline constexpr double infinity = std::numeric_limits<double>::infinity();

inline SceneSurface surfaceOf(Shape shape, Pose pose = {}) {
    SceneSurface surface;
    surface.name = "surface";
    surface.shape = std::move(shape);
    surface.pose = pose;
    surface.material = {{"wood", 1.0}};
    return surface;
}

inline Scene sceneOf(std::vector<SceneSurface> surfaces, double tipRadiusMetres = 0.001) {
    return {std::move(surfaces), tipRadiusMetres, 90.0};
}

/// Samples at a constant rate along a path that maps times to positions.
template <typename Path>
std::vector<TipSample> sampledPath(double seconds, double rateHz, Path&& path) {
    std::vector<TipSample> samples;
    const int count = static_cast<int>(std::floor(seconds * rateHz + 1e-9)) + 1;
    for (int frame = 0; frame < count; ++frame) {
        const double time = frame / rateHz;
        samples.push_back({time, path(time), std::nullopt, std::nullopt});
    }
    return samples;
}

inline std::vector<ContactReading> play(ContactTracker& tracker, const std::vector<TipSample>& samples) {
    std::vector<ContactReading> readings;
    readings.reserve(samples.size());
    for (const TipSample& sample : samples) {
        readings.push_back(tracker.update(sample));
    }
    return readings;
}

inline double speedOf(const ContactReading& reading) {
    return std::hypot(reading.tangentialVelocityMps.x, reading.tangentialVelocityMps.y);
}

inline double degreesBetween(const glm::dvec3& a, const glm::dvec3& b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)) * 180.0 / std::numbers::pi;
}

inline glm::dquat turned(double degrees, const glm::dvec3& axis) {
    return glm::angleAxis(degrees * std::numbers::pi / 180.0, glm::normalize(axis));
}

/// True if every number of the reading is finite and within its documented range.
inline bool isSane(const ContactReading& reading) {
    const auto finite = [](const glm::dvec3& vector) {
        return std::isfinite(vector.x) && std::isfinite(vector.y) && std::isfinite(vector.z);
    };
    return std::isfinite(reading.timeSeconds) && finite(reading.pointMetres) && finite(reading.normal) &&
           std::abs(glm::length(reading.normal) - 1.0) < 1e-9 && std::isfinite(reading.penetrationMetres) &&
           reading.penetrationMetres >= 0.0 && std::isfinite(speedOf(reading)) && speedOf(reading) <= 20.0 + 1e-9 &&
           std::isfinite(reading.approachSpeedMps) && reading.approachSpeedMps >= 0.0 &&
           std::isfinite(reading.forceNewtons) && reading.forceNewtons >= 0.0 && reading.forceNewtons <= 5.0;
}

/// A closed box mesh with outward faces, whose corners are separate vertices for each face, as in game engines.
struct RawMesh {
    std::vector<glm::dvec3> vertices;
    std::vector<TriangleMesh::Triangle> triangles;
};
inline RawMesh rawBoxMesh(const glm::dvec3& half) {
    RawMesh mesh;
    for (glm::length_t axis = 0; axis < 3; ++axis) {
        for (const double side : {-1.0, 1.0}) {
            glm::dvec3 normal(0.0);
            normal[axis] = side;
            glm::dvec3 u(0.0);
            u[(axis + 1) % 3] = 1.0;
            const glm::dvec3 v = glm::cross(normal, u);
            const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
            for (const auto& [a, b] : {std::pair(-1.0, -1.0), {1.0, -1.0}, {1.0, 1.0}, {-1.0, 1.0}}) {
                mesh.vertices.push_back(half * (normal + a * u + b * v));
            }
            mesh.triangles.push_back({first, first + 1, first + 2});
            mesh.triangles.push_back({first, first + 2, first + 3});
        }
    }
    return mesh;
}

/// A torus, which is not convex, around the y axis.
inline RawMesh rawTorus(double ringRadius, double tubeRadius, std::uint32_t around, std::uint32_t along) {
    RawMesh mesh;
    const double turn = 2.0 * std::numbers::pi;
    for (std::uint32_t i = 0; i < around; ++i) {
        for (std::uint32_t j = 0; j < along; ++j) {
            const double a = turn * i / around;
            const double b = turn * j / along;
            const double distance = ringRadius + tubeRadius * std::cos(b);
            mesh.vertices.emplace_back(distance * std::cos(a), tubeRadius * std::sin(b), distance * std::sin(a));
            const std::uint32_t iNext = (i + 1) % around;
            const std::uint32_t jNext = (j + 1) % along;
            mesh.triangles.push_back({i * along + j, i * along + jNext, iNext * along + jNext});
            mesh.triangles.push_back({i * along + j, iNext * along + jNext, iNext * along + j});
        }
    }
    return mesh;
}

inline std::shared_ptr<const TriangleMesh> meshOf(const RawMesh& raw) {
    return std::make_shared<const TriangleMesh>(raw.vertices, raw.triangles);
}

}  // namespace haptoflow::headless::testing
