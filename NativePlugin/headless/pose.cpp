#include "headless/pose.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace haptoflow::headless {

glm::dvec3 Pose::pointToWorld(const glm::dvec3& local) const noexcept {
    return positionMetres + rotation * local;
}

glm::dvec3 Pose::pointToLocal(const glm::dvec3& world) const noexcept {
    return glm::conjugate(rotation) * (world - positionMetres);
}

glm::dvec3 Pose::directionToWorld(const glm::dvec3& local) const noexcept {
    return rotation * local;
}

Pose sanitised(const Pose& pose) noexcept {
    return {isUsable(pose.positionMetres) ? pose.positionMetres : glm::dvec3(0.0), unitRotation(pose.rotation)};
}

bool isUsable(double value) noexcept {
    return std::abs(value) <= maximumCoordinate;
}

bool isUsable(const glm::dvec3& vector) noexcept {
    return isUsable(vector.x) && isUsable(vector.y) && isUsable(vector.z);
}

glm::dvec3 unitOr(const glm::dvec3& vector, const glm::dvec3& fallback) noexcept {
    if (!std::isfinite(vector.x) || !std::isfinite(vector.y) || !std::isfinite(vector.z)) {
        return fallback;
    }
    const double largest = std::max({std::abs(vector.x), std::abs(vector.y), std::abs(vector.z)});
    if (!(largest > 1e-300)) {
        return fallback;
    }
    const glm::dvec3 scaled = vector / largest;
    return scaled / std::sqrt(glm::dot(scaled, scaled));
}

glm::dquat unitRotation(const glm::dquat& rotation) noexcept {
    const double largest =
        std::max({std::abs(rotation.x), std::abs(rotation.y), std::abs(rotation.z), std::abs(rotation.w)});
    const double sum = rotation.x + rotation.y + rotation.z + rotation.w;
    if (!std::isfinite(sum) || !(largest > 1e-300)) {
        return {1.0, 0.0, 0.0, 0.0};
    }
    const glm::dquat scaled(rotation.w / largest, rotation.x / largest, rotation.y / largest, rotation.z / largest);
    return scaled / std::sqrt(glm::dot(scaled, scaled));
}

glm::dvec3 anyPerpendicular(const glm::dvec3& unit) noexcept {
    const glm::dvec3 size = glm::abs(unit);
    glm::dvec3 least(0.0, 0.0, 1.0);
    if (size.y <= size.x && size.y <= size.z) {
        least = {0.0, 1.0, 0.0};
    } else if (size.x <= size.z) {
        least = {1.0, 0.0, 0.0};
    }
    return unitOr(least - unit * glm::dot(least, unit), {1.0, 0.0, 0.0});
}

namespace {

// Sines of the angle between grain and normal: below the first only carried axes are used, above the second only the
// grain.
constexpr double carriedBelow = 0.342020143325669;
constexpr double grainAbove = 0.5;

// A finite step on a curved surface turns the projection slightly more than its derivative predicts.
constexpr double finiteStepAllowance = 1.2;

glm::dvec3 intoPlane(const glm::dvec3& vector, const glm::dvec3& normal) {
    return vector - normal * glm::dot(vector, normal);
}

double grainWeight(double sine) {
    const double u = std::clamp((sine - carriedBelow) / (grainAbove - carriedBelow), 0.0, 1.0);
    return u * u * (3.0 - 2.0 * u);
}

/// `axis`, rotated by the smallest rotation from `from` to `to`.
glm::dvec3 carried(const glm::dvec3& axis, const glm::dvec3& from, const glm::dvec3& to) {
    const double cosine = glm::dot(from, to);
    if (cosine < -1.0 + 1e-12) {
        return axis;
    }
    const glm::dvec3 turn = glm::cross(from, to);
    return axis + glm::cross(turn, axis) + glm::cross(turn, glm::cross(turn, axis)) / (1.0 + cosine);
}

}  // namespace

TangentFrame::TangentFrame(const glm::dvec3& grain) noexcept : grain_(unitOr(grain, {1.0, 0.0, 0.0})) {}

const TangentAxes& TangentFrame::update(const glm::dvec3& normal, double stepSeconds) noexcept {
    const glm::dvec3 unit = unitOr(normal, normal_);
    axes_.first = touching_ ? carriedFirstAxis(unit, stepSeconds) : firstAxisOfNewTouch(unit);
    axes_.second = glm::cross(unit, axes_.first);
    normal_ = unit;
    touching_ = true;
    return axes_;
}

glm::dvec3 TangentFrame::firstAxisOfNewTouch(const glm::dvec3& normal) const noexcept {
    const glm::dvec3 projected = intoPlane(grain_, normal);
    const bool useful = glm::length(projected) > carriedBelow;
    const glm::dvec3 reference = useful ? projected : intoPlane(anyPerpendicular(grain_), normal);
    return unitOr(reference, anyPerpendicular(normal));
}

glm::dvec3 TangentFrame::carriedFirstAxis(const glm::dvec3& normal, double stepSeconds) const noexcept {
    const glm::dvec3 first = unitOr(intoPlane(carried(axes_.first, normal_, normal), normal), anyPerpendicular(normal));
    const glm::dvec3 projected = intoPlane(grain_, normal);
    const double sine = glm::length(projected);
    const double weight = grainWeight(sine);
    if (weight <= 0.0) {
        return first;
    }
    double angle = std::atan2(glm::dot(glm::cross(first, projected), normal), glm::dot(first, projected));
    if (angle > 0.5 * std::numbers::pi) {
        angle -= std::numbers::pi;
    } else if (angle < -0.5 * std::numbers::pi) {
        angle += std::numbers::pi;
    }
    const double normalTurn = std::atan2(glm::length(glm::cross(normal_, normal)), glm::dot(normal_, normal));
    const double limit =
        weight * (turnRadiansPerSecond * std::max(0.0, stepSeconds) + finiteStepAllowance * normalTurn / sine);
    angle = std::clamp(angle, -limit, limit);
    return unitOr(std::cos(angle) * first + std::sin(angle) * glm::cross(normal, first), first);
}

}  // namespace haptoflow::headless
