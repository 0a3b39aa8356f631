#include "headless/contact_transitions.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace haptoflow::headless {
namespace {

// The reference place follows the contact at this distance, or for a few frames at the longer one while the normal
// turns: a slow tip that rolls over a rim turns only slightly from frame to frame, and a fast one may have a frame in
// the middle of the rim.
constexpr double shortDistanceMetres = 0.002;
constexpr double longDistanceMetres = 0.006;
constexpr int maximumFramesBehind = 2;
// The cosine of 5 degrees.
constexpr double steadyCosine = 0.9962;
// Places on the two faces of a rim lie below each other's planes, up to rounding and the unevenness of a mesh.
constexpr double flatnessMetres = 0.0001;

ContactPlace inWorld(const ContactPlace& local, const Pose& pose) {
    return {pose.pointToWorld(local.pointMetres), pose.directionToWorld(local.normal)};
}

double heightAbove(const ContactPlace& place, const glm::dvec3& point) {
    return glm::dot(point - place.pointMetres, place.normal);
}

bool isTurned(const ContactPlace& before, const ContactPlace& here) {
    return glm::dot(before.normal, here.normal) < ContactTransitions::faceCosine;
}

/// Height of the step from one place to the other. On a curved surface each place lies equally far below the other's
/// plane; at a step one of them lies above.
double stepBetween(const ContactPlace& before, const ContactPlace& here) {
    return 0.5 * std::abs(heightAbove(before, here.pointMetres) - heightAbove(here, before.pointMetres));
}

/// True for two faces that look at each other across less than the tip's width: no tip moves from one to the other.
bool isFacing(const ContactPlace& before, const ContactPlace& here, double tipRadiusMetres) {
    const double gapMetres = heightAbove(before, here.pointMetres);
    return glm::dot(before.normal, here.normal) < -ContactTransitions::faceCosine && gapMetres >= -flatnessMetres &&
           gapMetres <= std::max(2.0 * tipRadiusMetres, ContactTransitions::minimumRimMetres);
}

bool isConvex(const ContactPlace& before, const ContactPlace& here) {
    return heightAbove(before, here.pointMetres) <= flatnessMetres &&
           heightAbove(here, before.pointMetres) <= flatnessMetres;
}

}  // namespace

std::optional<std::size_t> ContactTransitions::referenceSurface() const noexcept {
    return reference_ ? std::optional(reference_->surface) : std::nullopt;
}

bool ContactTransitions::isElsewhere(const PosedPlace& now, const Pose& referencePose) const noexcept {
    return reference_ &&
           (now.surface != reference_->surface || glm::dot(referencePose.directionToWorld(reference_->local.normal),
                                                           now.pose.directionToWorld(now.local.normal)) < steadyCosine);
}

glm::dvec3 ContactTransitions::restingTip(const glm::dvec3& tipMetres, const Pose& referencePose) const noexcept {
    if (!reference_) {
        return tipMetres;
    }
    const ContactPlace before = inWorld(reference_->local, referencePose);
    return tipMetres + std::max(0.0, tipRadiusMetres_ - heightAbove(before, tipMetres)) * before.normal;
}

bool ContactTransitions::isCaughtBy(const PosedPlace& other, const Pose& referencePose,
                                    const glm::dvec3& restingTipMetres) const noexcept {
    if (!reference_) {
        return false;
    }
    const ContactPlace there = inWorld(other.local, other.pose);
    return heightAbove(there, restingTipMetres) <= 2.0 * tipRadiusMetres_ &&
           !isTurned(inWorld(reference_->local, referencePose), there);
}

ContactEvent ContactTransitions::advance(const PosedPlace& now, const Pose& referencePose,
                                         double approachSpeedMps) noexcept {
    if (!reference_) {
        moveReference(now, true);
        return {};
    }
    const ContactPlace before = inWorld(reference_->local, referencePose);
    const ContactPlace here = inWorld(now.local, now.pose);
    if (isFacing(before, here, tipRadiusMetres_)) {
        return {};
    }
    const bool turned = isTurned(before, here);
    const bool isOther = now.surface != reference_->surface;
    const double stepMetres = stepBetween(before, here);
    ContactEvent event;
    if (turned || (isOther && stepMetres >= minimumStepMetres)) {
        if (approachSpeedMps >= landingSpeedMps) {
            event.landed = true;
        } else if (!turned) {
            event.edgeHeightMetres = stepMetres;
        } else if (reference_->isArmed && isConvex(before, here)) {
            event.edgeHeightMetres = rimHeightMetres();
        }
    }
    const bool isEvent = event.landed || event.edgeHeightMetres > 0.0;
    if (isEvent || isToBeMoved(now, before, here)) {
        moveReference(now, !isEvent);
    }
    return event;
}

double ContactTransitions::slideOff(const PosedPlace& nearest, const Pose& referencePose, const glm::dvec3& tipMetres,
                                    double heightMetres) const noexcept {
    if (!reference_ || !reference_->isArmed || nearest.surface != reference_->surface) {
        return 0.0;
    }
    const ContactPlace before = inWorld(reference_->local, referencePose);
    const ContactPlace here = inWorld(nearest.local, nearest.pose);
    double aboveMetres = heightAbove(before, tipMetres);
    if (reference_->earlier) {
        // A frame of a fast tip may have been on the rim itself, where the normal points outwards.
        aboveMetres = std::min(aboveMetres, heightAbove(inWorld(*reference_->earlier, referencePose), tipMetres));
    }
    const bool isLow = aboveMetres - tipRadiusMetres_ <= heightMetres;
    const bool isNear = glm::distance(tipMetres, here.pointMetres) - tipRadiusMetres_ <= slideOffReachMetres;
    return isLow && isNear && isTurned(before, here) ? rimHeightMetres() : 0.0;
}

double ContactTransitions::rimHeightMetres() const noexcept {
    return std::max(tipRadiusMetres_, minimumRimMetres);
}

bool ContactTransitions::isToBeMoved(const PosedPlace& now, const ContactPlace& before,
                                     const ContactPlace& here) noexcept {
    if (now.surface != reference_->surface) {
        return true;
    }
    // On one surface, measure the distance on it, so that the surface's own motion does not count.
    const double distanceMetres = glm::distance(now.local.pointMetres, reference_->local.pointMetres);
    const bool isSteady = glm::dot(before.normal, here.normal) > steadyCosine;
    if (distanceMetres > shortDistanceMetres && (isSteady || !reference_->isArmed)) {
        return true;
    }
    // On a round surface each place lies equally far below the other's plane; in the middle of a rim it does not.
    const bool isRound = stepBetween(before, here) < minimumStepMetres;
    return distanceMetres > longDistanceMetres && (isRound || ++reference_->framesBehind > maximumFramesBehind);
}

void ContactTransitions::moveReference(const PosedPlace& now, bool isArmed) noexcept {
    const bool isSame = reference_ && reference_->surface == now.surface;
    reference_ = Reference{now.surface, now.local, isSame ? std::optional(reference_->local) : std::nullopt, isArmed};
}

}  // namespace haptoflow::headless
