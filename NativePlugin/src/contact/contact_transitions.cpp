#include "contact/contact_transitions.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace haptoflow::contact {
namespace {

// The reference stays behind by this way, and by the longer one while the normal turns: a slow tip that rolls over a rim
// turns by little from frame to frame.
constexpr double shortWayMetres = 0.002;
constexpr double longWayMetres = 0.006;
// The cosine of 5 degrees.
constexpr double steadyCosine = 0.9962;
// Places on the two faces of a rim lie below each other's planes but for rounding and a mesh's unevenness.
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

/// Where a surface curves, each of two places lies as far below the other's plane; over a step one lies above.
double stepBetween(const ContactPlace& before, const ContactPlace& here) {
    return 0.5 * std::abs(heightAbove(before, here.pointMetres) - heightAbove(here, before.pointMetres));
}

bool isConvex(const ContactPlace& before, const ContactPlace& here) {
    return heightAbove(before, here.pointMetres) <= flatnessMetres &&
           heightAbove(here, before.pointMetres) <= flatnessMetres;
}

}  // namespace

std::optional<std::size_t> ContactTransitions::referenceSurface() const noexcept {
    return reference_ ? std::optional(reference_->surface) : std::nullopt;
}

ContactEvent ContactTransitions::advance(const PosedPlace& now, const Pose& referencePose,
                                         double approachSpeedMps) noexcept {
    if (!reference_) {
        reference_ = Reference{now.surface, now.local};
        return {};
    }
    const ContactPlace before = inWorld(reference_->local, referencePose);
    const ContactPlace here = inWorld(now.local, now.pose);
    const bool turned = isTurned(before, here);
    const bool isOther = now.surface != reference_->surface;
    const double stepMetres = stepBetween(before, here);
    ContactEvent event;
    if (turned || (isOther && stepMetres >= lowestStepMetres)) {
        if (approachSpeedMps >= landingSpeedMps) {
            event.landed = true;
        } else if (!turned) {
            event.edgeHeightMetres = stepMetres;
        } else if (reference_->isArmed && isConvex(before, here)) {
            event.edgeHeightMetres = rimHeightMetres();
        }
    }
    moveReference(now, before, here, event.landed || event.edgeHeightMetres > 0.0);
    return event;
}

double ContactTransitions::slideOff(const PosedPlace& nearest, const Pose& referencePose, const glm::dvec3& tipMetres,
                                    double heightMetres) const noexcept {
    if (!reference_ || !reference_->isArmed || nearest.surface != reference_->surface) {
        return 0.0;
    }
    const ContactPlace before = inWorld(reference_->local, referencePose);
    const ContactPlace here = inWorld(nearest.local, nearest.pose);
    const bool isLow = heightAbove(before, tipMetres) - tipRadiusMetres_ <= heightMetres;
    const bool isNear = glm::distance(tipMetres, here.pointMetres) - tipRadiusMetres_ <= slideOffReachMetres;
    return isLow && isNear && isTurned(before, here) ? rimHeightMetres() : 0.0;
}

double ContactTransitions::rimHeightMetres() const noexcept {
    return std::max(tipRadiusMetres_, lowestRimMetres);
}

void ContactTransitions::moveReference(const PosedPlace& now, const ContactPlace& before, const ContactPlace& here,
                                       bool isEvent) noexcept {
    const bool isOther = now.surface != reference_->surface;
    // On one surface the way is that over it, whatever its own motion.
    const double way = isOther ? longWayMetres : glm::distance(now.local.pointMetres, reference_->local.pointMetres);
    const bool isSteady = glm::dot(before.normal, here.normal) > steadyCosine;
    if (isEvent) {
        reference_ = Reference{now.surface, now.local, false};
    } else if (way >= longWayMetres || (way > shortWayMetres && isSteady)) {
        reference_ = Reference{now.surface, now.local};
    }
}

}  // namespace haptoflow::contact
