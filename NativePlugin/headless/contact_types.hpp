#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string_view>

namespace haptoflow::headless {

/// A measured position of the tip.
struct TipSample {
    double timeSeconds = 0.0;
    /// Centre of the tip sphere.
    glm::dvec3 positionMetres{0.0};
    /// The tip force that the stylus measures; replaces the spring force.
    std::optional<double> forceNewtons;
    /// Orientation of the pen. The contact model does not use it: the contact of a spherical tip does not depend on it.
    std::optional<glm::dquat> orientation;
};

/// One contact state with its place, as scenes without an engine need it. Every number is finite for every input.
struct ContactReading {
    double timeSeconds = 0.0;
    bool touching = false;
    /// Number of touch-downs; sliding from one surface to the next without lifting is one touch.
    std::uint32_t touchCounter = 0;
    /// Index in Scene::surfaces; -1 without touch.
    int surfaceIndex = -1;
    /// The contact point on the surface; the tip's centre without touch.
    glm::dvec3 pointMetres{0.0};
    /// Outward unit normal of the surface; +y without touch.
    glm::dvec3 normal{0.0, 1.0, 0.0};
    /// Penetration depth: the tip radius minus the signed distance, 0 or more.
    double penetrationMetres = 0.0;
    /// Velocity of the tip relative to the surface, along the surface's two tangent axes.
    glm::dvec2 tangentialVelocityMps{0.0};
    /// Speed into the surface at this touch's newest landing, 0 or more; 0 without touch.
    double approachSpeedMps = 0.0;
    double forceNewtons = 0.0;
    /// Number of landings within touches: on another surface, or on another face of the same.
    std::uint32_t landingCounter = 0;
    /// Number of edges: rims that the tip crosses or slides off, and steps from one surface to the next.
    std::uint32_t edgeCounter = 0;
    /// Height of the newest edge; 0 before the first.
    double edgeHeightMetres = 0.0;
    /// The contact point and the two tangent axes in the surface's local frame; zero without touch.
    glm::dvec3 placeMetres{0.0};
    glm::dvec3 firstAxis{0.0};
    glm::dvec3 secondAxis{0.0};
};

/// Settings of the velocity estimate from tracked positions. See TipPath.
struct VelocitySettings {
    /// The longest time from which positions are taken, no whole number of usual frames, so that rounding does not
    /// decide how many; two positions are always taken.
    double windowSeconds = 0.105;
    /// The time over which the speed of an approach is averaged, or three positions if they are sparser: what a tip
    /// meets has turned it by the time that it is noticed.
    double approachSeconds = 0.035;
    /// A repeated position counts as held by a tracker that repeats itself up to this time, then the velocity fades.
    double holdSeconds = 0.030;
    /// A position repeated for this long by such a tracker means that the tip has stopped.
    double stopSeconds = 0.050;
    /// A longer pause drops the history.
    double maximumGapSeconds = 0.250;
    /// Samples closer in time than this would only add noise to the line.
    double minimumStepSeconds = 0.0005;
    /// A position that moved less than this counts as repeated.
    double minimumMoveMetres = 1e-7;
    /// A faster move over the surface is a jump. Hands reach a quarter of this speed.
    double maximumSpeedMps = 20.0;
    /// A tip that gains more speed from one measurement to the next, and more than this acceleration gives in the time,
    /// has jumped. Strokes of people gain 2 m/s at 200 Hz and 1.4 m/s at 72 Hz at most, 100 m/s^2.
    double jumpGainMps = 2.5;
    double jumpAccelerationMps2 = 150.0;
    /// Minimum time used to compute a jump's speed, so that jittering time stamps do not look like jumps.
    double minimumJumpSeconds = 0.005;

    /// A move longer than this within `seconds` is a jump. The allowance keeps a move at exactly the maximum speed
    /// from counting as one because of rounding.
    [[nodiscard]] double maximumMoveMetres(double seconds) const noexcept {
        return (1.0 + 1e-6) * maximumSpeedMps * std::max(seconds, minimumJumpSeconds);
    }
    /// The most speed that a hand gains in a time.
    [[nodiscard]] double maximumGainMps(double seconds) const noexcept {
        return std::max(jumpGainMps, jumpAccelerationMps2 * seconds);
    }
    /// True if the tip moved further than a hand can in this time: it was put there, as by a teleport. The speed before
    /// the step is infinite if it is not known.
    [[nodiscard]] bool isJump(double movedMetres, double seconds, double speedBeforeMps) const noexcept {
        const double step = std::max(seconds, minimumJumpSeconds);
        return movedMetres > maximumMoveMetres(step) || movedMetres > (speedBeforeMps + maximumGainMps(step)) * step;
    }
};

struct ContactSettings {
    double maximumForceNewtons = 5.0;
    /// Stiffness of surfaces without a stiffness of their own or of their label.
    double defaultStiffnessNewtonsPerMetre = 500.0;
    /// A touch ends when the gap between tip and surface exceeds this.
    double releaseDistanceMetres = 0.0005;
    /// Another surface, or another face of the same, replaces the present one only if it is deeper by this much.
    double switchMarginMetres = 0.0005;
    /// Depth behind an open mesh up to which the tip's centre counts as inside.
    double openMeshDepthMetres = 0.005;
    /// A touch ends if the tip's position is unusable for longer than this.
    double lostSeconds = 0.100;
    VelocitySettings velocity;
    /// Returns a label's default stiffness in N/m, or nothing for an unknown label. May be empty itself.
    std::function<std::optional<double>(std::string_view label)> stiffnessOfLabel;
};

/// Counts of corrected input and of the work done, since construction.
struct ContactStatistics {
    std::uint64_t samples = 0;
    /// Samples with an unusable time, position or force.
    std::uint64_t sanitisedSamples = 0;
    /// Jumps of the tip over the surface that it touched.
    std::uint64_t teleports = 0;
    /// How often the time went backwards, which drops the history.
    std::uint64_t clockRestarts = 0;
    std::uint64_t touchDowns = 0;
    /// Narrow phase: surfaces whose exact distance was computed.
    std::uint64_t surfaceQueries = 0;
    /// Broad phase: surfaces that were considered although their bounding sphere was out of reach.
    std::uint64_t surfacesRuledOut = 0;
};

}  // namespace haptoflow::headless
