#pragma once

#include "headless/bounds_tree.hpp"
#include "headless/pose.hpp"
#include "headless/shape.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace haptoflow::headless {

/// A pose at a time on the stroke's clock.
struct Keyframe {
    double timeSeconds = 0.0;
    Pose pose;
};

/// A path through keyframes. Positions follow a cubic spline through the keyframes with continuous velocity. Rotations
/// turn the shorter way at a constant rate between two keyframes, so that neighbouring rotations must differ by less
/// than half a turn. The object rests before the first keyframe and after the last. A loop starts again instead and
/// should end in the pose that it began with.
class Motion {
public:
    /// Two keyframes or more, with strictly increasing times.
    Motion(std::vector<Keyframe> keyframes, bool loop);

    [[nodiscard]] Pose poseAt(double timeSeconds) const noexcept;
    /// A box around every position on the path, in metres, up to rounding.
    [[nodiscard]] Bounds bounds() const noexcept;
    [[nodiscard]] const std::vector<Keyframe>& keyframes() const noexcept { return keyframes_; }

private:
    [[nodiscard]] glm::dvec3 chordVelocity(std::size_t from, std::size_t to) const noexcept;
    [[nodiscard]] glm::dvec3 velocityAtKeyframe(std::size_t index) const noexcept;

    std::vector<Keyframe> keyframes_;
    bool loop_;
    bool closed_ = false;
};

/// The map of heights that lies on a surface, along the axes of the tip's velocity over it: what a reader of scenes
/// loads, and a voice then follows.
struct SceneRelief {
    /// As the scene names it; relative to the scene's file.
    std::string image;
    /// The image holds normals instead of heights.
    bool isNormalMap = false;
    /// Of one tile.
    std::array<double, 2> sizeMetres{};
    /// From black to white, or from the lowest to the highest of the integrated heights.
    double depthMetres = 0.0;
    bool isTiled = true;
    /// Of the full scale, which the relief may reach.
    double share = 0.5;
};

/// An object of a scene that the tip can touch.
struct SceneSurface {
    std::string name;
    Shape shape;
    Pose pose;
    /// Replaces `pose` if set.
    std::optional<Motion> motion;
    /// Labels and weights; the weights sum to 1.
    std::vector<std::pair<std::string, double>> material;
    std::optional<double> stiffnessNewtonsPerMetre;
    /// Direction of the first tangent axis, in the object's local frame.
    glm::dvec3 grain{1.0, 0.0, 0.0};
    /// Size of the surface's features relative to the material's, and tilt of its spectrum in dB per octave.
    double spatialScale = 1.0;
    double toneDbPerOctave = 0.0;
    /// How much the object differs from others with the same labels, 0 to 1: which one it is, its seed says.
    double variation = 0.0;
    /// Names the surface: another number has another field of asperities and, with a variation, is another object.
    std::uint32_t seed = 0;
    std::optional<SceneRelief> relief = std::nullopt;

    [[nodiscard]] Pose poseAt(double timeSeconds) const noexcept {
        return motion ? motion->poseAt(timeSeconds) : sanitised(pose);
    }
};

/// The surfaces that a stylus can touch, and the stylus's tip.
struct Scene {
    std::vector<SceneSurface> surfaces;
    double tipRadiusMetres = 0.001;
    /// Contact states per second that are computed along a stroke.
    double updateRateHz = 90.0;
};

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
