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

/// Where the stylus says its tip is.
struct TipSample {
    double timeSeconds = 0.0;
    /// Centre of the tip sphere.
    glm::dvec3 positionMetres{0.0};
    /// The stylus's own tip force; takes the place of the spring.
    std::optional<double> forceNewtons;
    /// Of the pen. A spherical tip touches the same whichever way the pen points, so contact does not read it.
    std::optional<glm::dquat> orientation;
};

/// One contact state with where it comes from. Every number is finite, whatever the input.
struct ContactReading {
    double timeSeconds = 0.0;
    bool touching = false;
    /// Counts touch-downs; sliding from one surface to the next without lifting is one touch.
    std::uint32_t touchCounter = 0;
    /// Into Scene::surfaces; -1 without touch.
    int surfaceIndex = -1;
    /// On the surface; the tip's centre without touch.
    glm::dvec3 pointMetres{0.0};
    /// Unit length, out of the surface; +y without touch.
    glm::dvec3 normal{0.0, 1.0, 0.0};
    /// Tip radius minus signed distance, not below 0.
    double penetrationMetres = 0.0;
    /// Of the tip relative to the surface, along the surface's two tangent axes.
    glm::dvec2 tangentialVelocityMps{0.0};
    /// Into the surface at this touch's newest landing, not below 0; 0 without touch.
    double approachSpeedMps = 0.0;
    double forceNewtons = 0.0;
    /// Counts landings within touches: on another surface, or on another face of the same.
    std::uint32_t landingCounter = 0;
    /// Counts edges: rims that the tip crosses or slides off, and steps from one surface to the next.
    std::uint32_t edgeCounter = 0;
    /// Of the newest edge; 0 before the first.
    double edgeHeightMetres = 0.0;
};

/// How a velocity is made from tracked positions. See TipHistory.
struct VelocitySettings {
    /// The line through the positions covers this much time, or three positions where they are sparser.
    double windowSeconds = 0.035;
    /// A repeated position counts as tracker hold up to here, then the velocity fades.
    double holdSeconds = 0.030;
    /// A position repeated for this long is a stop.
    double stopSeconds = 0.050;
    /// After a longer pause nothing of the past counts.
    double longestGapSeconds = 0.250;
    /// Samples closer than this in time add nothing to the line but noise.
    double shortestStepSeconds = 0.0005;
    /// A position that moved less than this is repeated.
    double smallestMoveMetres = 1e-7;
    /// Faster than this is a teleport. Hands reach a quarter of it.
    double fastestMps = 20.0;
    /// The shortest time over which a jump's speed is judged, so that jittering time stamps are no teleports.
    double shortestJumpSeconds = 0.005;

    /// A move longer than this in so much time is a teleport. The fastest speed itself is none, however its times and
    /// places are rounded.
    [[nodiscard]] double longestMoveMetres(double seconds) const noexcept {
        return (1.0 + 1e-6) * fastestMps * std::max(seconds, shortestJumpSeconds);
    }
};

struct ContactSettings {
    double maximumForceNewtons = 5.0;
    /// Of surfaces that neither say nor look up their own.
    double defaultStiffnessNewtonsPerMetre = 500.0;
    /// A touch ends where the gap between tip and surface exceeds this.
    double releaseDistanceMetres = 0.0005;
    /// Another surface, or another face of the same, takes over only where it is ahead by this much.
    double switchMarginMetres = 0.0005;
    /// How far behind an open mesh the tip's centre still counts as inside it.
    double openMeshDepthMetres = 0.005;
    /// A touch ends where the tip's position stays unusable for longer than this.
    double lostSeconds = 0.100;
    VelocitySettings velocity;
    /// Default stiffness of a label in N/m, empty for labels it does not know. May be empty itself.
    std::function<std::optional<double>(std::string_view label)> stiffnessOfLabel;
};

/// What had to be put right, and what was left out. Counts since construction.
struct ContactStatistics {
    std::uint64_t samples = 0;
    /// Samples with a time, position or force that was not usable.
    std::uint64_t sanitisedSamples = 0;
    std::uint64_t teleports = 0;
    /// The time went backwards and the past was dropped.
    std::uint64_t clockRestarts = 0;
    std::uint64_t touchDowns = 0;
    /// The narrow phase: surfaces whose exact distance was computed.
    std::uint64_t surfaceQueries = 0;
    /// The broad phase's vain effort: surfaces that it looked at and whose bounding sphere was out of reach.
    std::uint64_t surfacesRuledOut = 0;
};

}  // namespace haptoflow::headless
