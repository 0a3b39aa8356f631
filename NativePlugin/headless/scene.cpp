#include "headless/scene.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace haptoflow::headless {

Motion::Motion(std::vector<Keyframe> keyframes, bool loop) : keyframes_(std::move(keyframes)), loop_(loop) {
    for (Keyframe& keyframe : keyframes_) {
        keyframe.pose = sanitised(keyframe.pose);
    }
    closed_ =
        loop_ && glm::distance(keyframes_.front().pose.positionMetres, keyframes_.back().pose.positionMetres) < 1e-9;
}

glm::dvec3 Motion::chordVelocity(std::size_t from, std::size_t to) const noexcept {
    return (keyframes_[to].pose.positionMetres - keyframes_[from].pose.positionMetres) /
           (keyframes_[to].timeSeconds - keyframes_[from].timeSeconds);
}

glm::dvec3 Motion::velocityAtKeyframe(std::size_t index) const noexcept {
    const std::size_t last = keyframes_.size() - 1;
    if (index > 0 && index < last) {
        return chordVelocity(index - 1, index + 1);
    }
    if (closed_ && last > 1) {
        const double seconds = keyframes_[1].timeSeconds - keyframes_[0].timeSeconds + keyframes_[last].timeSeconds -
                               keyframes_[last - 1].timeSeconds;
        return (keyframes_[1].pose.positionMetres - keyframes_[last - 1].pose.positionMetres) / seconds;
    }
    return index == 0 ? chordVelocity(0, 1) : chordVelocity(last - 1, last);
}

Pose Motion::poseAt(double timeSeconds) const noexcept {
    const double first = keyframes_.front().timeSeconds;
    const double last = keyframes_.back().timeSeconds;
    double time = isUsable(timeSeconds) ? timeSeconds : first;
    if (loop_) {
        const double period = last - first;
        time = first + (time - first) - period * std::floor((time - first) / period);
    }
    if (time <= first) {
        return keyframes_.front().pose;
    }
    if (time >= last) {
        return keyframes_.back().pose;
    }
    const auto after =
        std::upper_bound(keyframes_.begin(), keyframes_.end(), time,
                         [](double wanted, const Keyframe& frame) { return wanted < frame.timeSeconds; });
    const auto right = static_cast<std::size_t>(after - keyframes_.begin());
    const Keyframe& a = keyframes_[right - 1];
    const Keyframe& b = keyframes_[right];
    const double span = b.timeSeconds - a.timeSeconds;
    const double u = (time - a.timeSeconds) / span;
    const double toB = u * u * (3.0 - 2.0 * u);
    const double leaving = span * u * (1.0 - u) * (1.0 - u);
    const double arriving = span * u * u * (u - 1.0);
    return {a.pose.positionMetres + toB * (b.pose.positionMetres - a.pose.positionMetres) +
                leaving * velocityAtKeyframe(right - 1) + arriving * velocityAtKeyframe(right),
            unitRotation(glm::slerp(a.pose.rotation, b.pose.rotation, u))};
}

Bounds Motion::bounds() const noexcept {
    Bounds bounds;
    for (std::size_t right = 1; right < keyframes_.size(); ++right) {
        const Keyframe& a = keyframes_[right - 1];
        const Keyframe& b = keyframes_[right];
        const double third = (b.timeSeconds - a.timeSeconds) / 3.0;
        // The cubic lies within the convex hull of its four Bezier points.
        bounds.include(a.pose.positionMetres);
        bounds.include(a.pose.positionMetres + third * velocityAtKeyframe(right - 1));
        bounds.include(b.pose.positionMetres - third * velocityAtKeyframe(right));
        bounds.include(b.pose.positionMetres);
    }
    return bounds;
}

namespace {

// The tree uses world coordinates, `reaches` local ones. The conversion rounds about ten times by 1e-16, relative to
// the largest number in it; this allowance keeps the tree from missing a surface because of that.
constexpr double roundingAllowance = 1e-12;

}  // namespace

BroadPhase::BroadPhase(const std::vector<SceneSurface>& surfaces, double reachMetres) : reachMetres_(reachMetres) {
    spheres_.reserve(surfaces.size());
    std::vector<Bounds> boxes;
    for (std::uint32_t index = 0; index < surfaces.size(); ++index) {
        const BoundingSphere& sphere = spheres_.emplace_back(boundingSphere(surfaces[index].shape));
        const Bounds box = withinReachOf(surfaces[index], sphere);
        if (isUsable(box.lowest) && isUsable(box.highest)) {
            bounded_.push_back(index);
            boxes.push_back(box);
        } else {
            endless_.push_back(index);
        }
    }
    tree_ = BoundsTree(boxes);
}

bool BroadPhase::reaches(std::size_t surface, const glm::dvec3& localTipMetres) const noexcept {
    const BoundingSphere& sphere = spheres_[surface];
    return glm::distance(localTipMetres, sphere.centreMetres) <= sphere.radiusMetres + reachMetres_;
}

bool BroadPhase::passes(std::size_t surface, const glm::dvec3& tipBefore, const Pose& poseBefore,
                        const glm::dvec3& tipMetres, const Pose& pose) const noexcept {
    const BoundingSphere& sphere = spheres_[surface];
    const glm::dvec3 from = tipBefore - poseBefore.pointToWorld(sphere.centreMetres);
    const glm::dvec3 path = tipMetres - pose.pointToWorld(sphere.centreMetres) - from;
    const double square = glm::dot(path, path);
    const double share = square > 0.0 ? glm::clamp(-glm::dot(from, path) / square, 0.0, 1.0) : 0.0;
    return glm::length(from + share * path) <= sphere.radiusMetres + reachMetres_;
}

Bounds BroadPhase::withinReachOf(const SceneSurface& surface, const BoundingSphere& sphere) const noexcept {
    Bounds box;
    double around = sphere.radiusMetres + reachMetres_;
    if (surface.motion) {
        // The margin below covers every rotation along the path.
        box = surface.motion->bounds();
        around += glm::length(sphere.centreMetres);
    } else {
        box.include(sanitised(surface.pose).pointToWorld(sphere.centreMetres));
    }
    const double largest =
        glm::length(box.lowest) + glm::length(box.highest) + glm::length(sphere.centreMetres) + around;
    const glm::dvec3 margin(around + roundingAllowance * largest);
    return {box.lowest - margin, box.highest + margin};
}

}  // namespace haptoflow::headless
