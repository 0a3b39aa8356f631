#pragma once

#include "headless/pose.hpp"

#include <cstddef>
#include <glm/vec3.hpp>
#include <optional>

namespace haptoflow::headless {

/// A place on a surface, in the surface's local frame or in world space.
struct ContactPlace {
    glm::dvec3 pointMetres{0.0};
    /// Outward unit normal.
    glm::dvec3 normal{0.0, 1.0, 0.0};
};

/// A place in its surface's local frame, with the present pose of that surface.
struct PosedPlace {
    std::size_t surface = 0;
    ContactPlace local;
    Pose pose;
};

/// What happened to the tip between two frames.
struct ContactEvent {
    /// The tip landed on another surface, or on another face of the same, with a speed into it.
    bool landed = false;
    /// Height of the edge that the tip crossed; 0 for none.
    double edgeHeightMetres = 0.0;
};

/// Distinguishes landings and edges from smooth sliding while a tip stays in contact.
///
/// The face changes when the normal turns by 40 degrees over a short distance, as at the rim of a box but not on a
/// ball. If the tip moves into the new face, it lands on it. If not, it crosses an edge: either a rim, whose height is
/// the tip's radius because the tip can fall that far, or the step between two adjacent surfaces. Surfaces that are
/// flush have neither.
///
/// A hand without force feedback presses deep into objects, and deep inside two adjacent blocks the nearest faces are
/// the inner ones. A change is therefore judged at the place where the tip would rest on its previous face: see
/// `restingTip`.
class ContactTransitions {
public:
    /// A tip that moves into a face more slowly than this slides onto it instead of landing.
    static constexpr double landingSpeedMps = 0.03;
    /// The cosine of 40 degrees: a prism with eight sides has edges, rounder ones have none.
    static constexpr double faceCosine = 0.766;
    /// Lower steps are ignored: tracking and meshes are not more accurate than this.
    static constexpr double minimumStepMetres = 0.0001;
    /// A tip that is farther away in the next frame has jumped and not slid off.
    static constexpr double slideOffReachMetres = 0.05;
    /// Minimum height of a rim, for tips of any radius.
    static constexpr double minimumRimMetres = 0.0005;

    explicit ContactTransitions(double tipRadiusMetres) noexcept : tipRadiusMetres_(tipRadiusMetres) {}

    /// Drops the reference: the next place is not compared with another one.
    void forget() noexcept { reference_.reset(); }
    /// The surface whose present pose `advance` and `slideOff` need as `referencePose`; empty if they need none.
    [[nodiscard]] std::optional<std::size_t> referenceSurface() const noexcept;

    /// True if `now` is on another surface than the reference, or its normal differs from that of the reference.
    [[nodiscard]] bool isElsewhere(const PosedPlace& now, const Pose& referencePose) const noexcept;
    /// The tip's centre, moved out of the reference's face until the tip just touches that face.
    [[nodiscard]] glm::dvec3 restingTip(const glm::dvec3& tipMetres, const Pose& referencePose) const noexcept;
    /// True if a tip at rest that crosses a rim falls onto `other`, a place on another surface. The rim then does not
    /// count as an edge; the step does, once the tip is on that surface.
    [[nodiscard]] bool isCaughtBy(const PosedPlace& other, const Pose& referencePose,
                                  const glm::dvec3& restingTipMetres) const noexcept;
    /// Processes a tip that touches `now` and moves into it at `approachSpeedMps`. If the face changes, `now` is the
    /// place of a tip at rest.
    ContactEvent advance(const PosedPlace& now, const Pose& referencePose, double approachSpeedMps) noexcept;
    /// Processes the end of a touch; `nearest` is the place of the touched surface nearest to the tip. If the tip is at
    /// most `heightMetres` above its previous face, it slid off: returns the height of that edge, or 0 if the tip was
    /// lifted.
    [[nodiscard]] double slideOff(const PosedPlace& nearest, const Pose& referencePose, const glm::dvec3& tipMetres,
                                  double heightMetres) const noexcept;

private:
    struct Reference {
        std::size_t surface = 0;
        ContactPlace local;
        /// An earlier place on the same surface.
        std::optional<ContactPlace> earlier;
        /// False after an edge until the tip has left the rim, so that a slow tip gets one edge per rim.
        bool isArmed = true;
        /// Number of frames for which the reference has followed at the longer distance.
        int framesBehind = 0;
    };

    [[nodiscard]] double rimHeightMetres() const noexcept;
    [[nodiscard]] bool isToBeMoved(const PosedPlace& now, const ContactPlace& before,
                                   const ContactPlace& here) noexcept;
    void moveReference(const PosedPlace& now, bool isArmed) noexcept;

    double tipRadiusMetres_;
    std::optional<Reference> reference_;
};

}  // namespace haptoflow::headless
