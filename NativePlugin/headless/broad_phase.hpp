#pragma once

#include "headless/bounds_tree.hpp"
#include "headless/scene.hpp"

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

namespace haptoflow::headless {

/// Which surfaces of a scene a tip can meet at all, so that a frame asks those few for their exact distance and not
/// every one. They stand in a tree that is built once, each where it rests or, if it moves, in a box around its whole
/// path: one that roams widely is asked more often than one that stays. Planes have no end and are always
/// asked.
class BroadPhase {
public:
    /// `reachMetres`: how far from the tip's centre a surface still matters. Every shape must have an extent; later
    /// changes to `surfaces` go unnoticed.
    BroadPhase(const std::vector<Surface>& surfaces, double reachMetres);

    /// Calls `consider(surface)` once for every surface that `reaches` would let pass, and for a few more; in no
    /// particular order. `tipMetres` must be usable.
    template <typename Consider>
    void visitNear(const glm::dvec3& tipMetres, Consider&& consider) const;

    /// Whether the surface's bounding sphere is within reach of the tip, which is given in the surface's local frame.
    [[nodiscard]] bool reaches(std::size_t surface, const glm::dvec3& localTipMetres) const noexcept;

private:
    [[nodiscard]] Bounds withinReachOf(const Surface& surface, const BoundingSphere& sphere) const noexcept;

    double reachMetres_;
    std::vector<BoundingSphere> spheres_;
    /// Planes, and what comes out of usable coordinates.
    std::vector<std::uint32_t> endless_;
    /// The tree's items, as indices of surfaces.
    std::vector<std::uint32_t> bounded_;
    BoundsTree tree_;
};

template <typename Consider>
void BroadPhase::visitNear(const glm::dvec3& tipMetres, Consider&& consider) const {
    for (const std::uint32_t surface : endless_) {
        consider(std::size_t{surface});
    }
    constexpr double onlyInside = 0.0;
    tree_.visitNear(tipMetres, onlyInside, [&](std::uint32_t item) {
        consider(std::size_t{bounded_[item]});
        return onlyInside;
    });
}

}  // namespace haptoflow::headless
