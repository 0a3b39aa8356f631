#include "headless/broad_phase.hpp"

#include "headless/pose.hpp"

#include <glm/geometric.hpp>

namespace haptoflow::headless {
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
