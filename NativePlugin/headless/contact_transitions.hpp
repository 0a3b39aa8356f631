#pragma once

#include "headless/pose.hpp"

#include <cstddef>
#include <glm/vec3.hpp>
#include <optional>

namespace haptoflow::headless {

/// A place on a surface, in the surface's local frame or in world space.
struct ContactPlace {
    glm::dvec3 pointMetres{0.0};
    /// Unit length, out of the surface.
    glm::dvec3 normal{0.0, 1.0, 0.0};
};

/// A place in its surface's local frame, with where that surface is now.
struct PosedPlace {
    std::size_t surface = 0;
    ContactPlace local;
    Pose pose;
};

/// What a tip met between two frames.
struct ContactEvent {
    /// On another surface, or on another face of the same, with speed into it.
    bool landed = false;
    /// Of an edge that the tip crossed; 0 for none.
    double edgeHeightMetres = 0.0;
};

/// Tells landings and edges from smooth sliding while a tip goes on touching.
///
/// A face changes where the normal turns by 40 degrees over a short way, as it does over the rim of a box and not over
/// a ball in the hand. A tip that moves into the new face lands on it; one that does not has crossed an edge: a rim,
/// which is as high as the tip's radius since that far the tip can fall, or the step between two surfaces that lie one
/// beside the other. Surfaces that are flush have neither.
///
/// A hand that nothing holds presses deep into things, and deep inside two blocks side by side their inner faces are
/// the nearest. So a change is judged where the tip would rest on the face that it was on: see `restingTip`.
class ContactTransitions {
public:
    /// A tip that moves more slowly into a face slides over to it.
    static constexpr double landingSpeedMps = 0.03;
    /// The cosine of 40 degrees: surfaces of eight sides have edges, rounder ones do not.
    static constexpr double faceCosine = 0.766;
    /// A lower step is none: tracking and meshes are no more exact.
    static constexpr double lowestStepMetres = 0.0001;
    /// A tip that is further away a frame later has not slid off but jumped.
    static constexpr double slideOffReachMetres = 0.05;
    /// Of the rim under a tip of any radius.
    static constexpr double lowestRimMetres = 0.0005;

    explicit ContactTransitions(double tipRadiusMetres) noexcept : tipRadiusMetres_(tipRadiusMetres) {}

    /// The next place compares with nothing.
    void forget() noexcept { reference_.reset(); }
    /// The surface whose pose now `advance` and `slideOff` want as `referencePose`; empty where they need none.
    [[nodiscard]] std::optional<std::size_t> referenceSurface() const noexcept;

    /// `now` is on another surface than the reference, or its normal leans away from that of the reference.
    [[nodiscard]] bool isElsewhere(const PosedPlace& now, const Pose& referencePose) const noexcept;
    /// The tip's centre, raised out of the face of the reference until it just touches that.
    [[nodiscard]] glm::dvec3 restingTip(const glm::dvec3& tipMetres, const Pose& referencePose) const noexcept;
    /// A resting tip that goes over a rim falls onto `other`, a place of another surface: then the rim is none, and
    /// what there is to feel is the step, once the tip is on that surface.
    [[nodiscard]] bool isCaughtBy(const PosedPlace& other, const Pose& referencePose,
                                  const glm::dvec3& restingTipMetres) const noexcept;
    /// The tip touches `now`, moving into it at `approachSpeedMps`. Where it is elsewhere: as a resting tip would.
    ContactEvent advance(const PosedPlace& now, const Pose& referencePose, double approachSpeedMps) noexcept;
    /// The touch has ended with `nearest` the place of the touched surface nearest to the tip. A tip that is still no
    /// higher than `heightMetres` above the face that it was on has slid off it: returns the height of that edge, and 0
    /// where the tip was lifted.
    [[nodiscard]] double slideOff(const PosedPlace& nearest, const Pose& referencePose, const glm::dvec3& tipMetres,
                                  double heightMetres) const noexcept;

private:
    struct Reference {
        std::size_t surface = 0;
        ContactPlace local;
        /// Where it was before, on the same surface.
        std::optional<ContactPlace> earlier;
        /// One rim is one edge, however slowly the tip rolls over it.
        bool isArmed = true;
        /// Frames that it has stayed behind by the long way.
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
