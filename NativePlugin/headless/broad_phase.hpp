#pragma once

#include "headless/bounds_tree.hpp"
#include "headless/scene.hpp"

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

namespace haptoflow::headless {

/// Finds the surfaces of a scene that are near the tip, so that a frame computes exact distances for those only. The
/// surfaces are kept in a tree that is built once: a surface at rest in its bounding box, a moving one in a box around
/// its whole path. A surface with a long path is therefore considered more often. Planes are infinite and are always
/// considered.
class BroadPhase {
public:
    /// `reachMetres`: the distance from the tip's centre up to which a surface matters. Every shape must have an
    /// extent. Later changes to `surfaces` have no effect.
    BroadPhase(const std::vector<SceneSurface>& surfaces, double reachMetres);

    /// Calls `consider(surface)` once for every surface that `reaches` would accept, and for a few more, in no
    /// particular order. `tipMetres` must be usable. With a distance, for every surface that would be accepted up to
    /// that far from the tip.
    template <typename Consider>
    void visitNear(const glm::dvec3& tipMetres, Consider&& consider, double withinMetres = 0.0) const;

    /// Whether the surface's bounding sphere is within reach of the tip, which is given in the surface's local frame.
    [[nodiscard]] bool reaches(std::size_t surface, const glm::dvec3& localTipMetres) const noexcept;
    /// Whether the tip came within reach of the surface's bounding sphere on its way between two positions relative to
    /// the surface's pose then and now.
    [[nodiscard]] bool passes(std::size_t surface, const glm::dvec3& tipBefore, const Pose& poseBefore,
                              const glm::dvec3& tipMetres, const Pose& pose) const noexcept;

private:
    [[nodiscard]] Bounds withinReachOf(const SceneSurface& surface, const BoundingSphere& sphere) const noexcept;

    double reachMetres_;
    std::vector<BoundingSphere> spheres_;
    /// Planes, and surfaces whose coordinates are not usable.
    std::vector<std::uint32_t> endless_;
    /// The tree's items, as indices of surfaces.
    std::vector<std::uint32_t> bounded_;
    BoundsTree tree_;
};

template <typename Consider>
void BroadPhase::visitNear(const glm::dvec3& tipMetres, Consider&& consider, double withinMetres) const {
    for (const std::uint32_t surface : endless_) {
        consider(std::size_t{surface});
    }
    const double squaredLimit = withinMetres * withinMetres;
    tree_.visitNear(tipMetres, squaredLimit, [&](std::uint32_t item) {
        consider(std::size_t{bounded_[item]});
        return squaredLimit;
    });
}

}  // namespace haptoflow::headless
