#include "headless/contact_tracker.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>

namespace haptoflow::headless {
namespace {

// Limits how far carried tangent axes turn after a pause: no further than in a slow frame.
constexpr double maximumFrameSeconds = 0.05;

bool positive(double value) {
    return value > 0.0 && isUsable(value);
}

double stiffnessOf(const SceneSurface& surface, const ContactSettings& settings) {
    if (surface.stiffnessNewtonsPerMetre && positive(*surface.stiffnessNewtonsPerMetre)) {
        return *surface.stiffnessNewtonsPerMetre;
    }
    double weighted = 0.0;
    double weights = 0.0;
    if (settings.stiffnessOfLabel) {
        for (const auto& [label, weight] : surface.material) {
            const std::optional<double> stiffness = settings.stiffnessOfLabel(label);
            if (stiffness && positive(*stiffness) && positive(weight)) {
                weighted += weight * *stiffness;
                weights += weight;
            }
        }
    }
    return weights > 0.0 ? weighted / weights : settings.defaultStiffnessNewtonsPerMetre;
}

}  // namespace

ContactTracker::ContactTracker(Scene scene, ContactSettings settings)
    : scene_(std::move(scene)),
      settings_(std::move(settings)),
      broadPhase_(scene_.surfaces, scene_.tipRadiusMetres + settings_.releaseDistanceMetres),
      history_(settings_.velocity),
      path_(settings_.velocity),
      transitions_(scene_.tipRadiusMetres) {
    for (const SceneSurface& surface : scene_.surfaces) {
        stiffnessNewtonsPerMetre_.push_back(stiffnessOf(surface, settings_));
        frames_.emplace_back(surface.grain);
    }
}

ContactReading ContactTracker::update(const TipSample& sample) {
    ++statistics_.samples;
    if (!acceptSample(sample)) {
        touched_.reset();
        forgetContinuity();
        transitions_.forget();
        return idle();
    }
    const bool wasTouching = touched_.has_value();
    continuePath();
    const std::optional<Candidate> contact = chooseContact();
    if (!contact) {
        noteSlideOff();
        touched_.reset();
        forgetContinuity();
        return idle();
    }
    if (touched_ != contact->surface) {
        forgetContinuity();
        frames_[contact->surface].reset();
        touched_ = contact->surface;
        beganHere_ = !wasTouching;
    }
    return describe(*contact, !wasTouching, sample);
}

/// Advances the clock, the tip and its history. Returns false if there is no usable tip position.
bool ContactTracker::acceptSample(const TipSample& sample) {
    const bool timeUsable = isUsable(sample.timeSeconds);
    const bool positionUsable = isUsable(sample.positionMetres);
    const bool forceUsable =
        !sample.forceNewtons || (std::isfinite(*sample.forceNewtons) && *sample.forceNewtons >= 0.0);
    if (!timeUsable || !positionUsable || !forceUsable) {
        ++statistics_.sanitisedSamples;
    }
    const double before = nowSeconds_;
    pathBefore_ = pathStart_;
    pathStart_ = tipMetres_ ? std::optional(TimedPlace{before, *tipMetres_}) : std::nullopt;
    if (timeUsable) {
        nowSeconds_ = sample.timeSeconds;
    }
    stepSeconds_ = started_ ? std::clamp(nowSeconds_ - before, 0.0, maximumFrameSeconds) : 0.0;
    started_ = started_ || timeUsable;
    if (positionUsable) {
        tipMetres_ = sample.positionMetres;
        tipSeconds_ = nowSeconds_;
    } else if (tipMetres_ && (!timeUsable || std::abs(nowSeconds_ - tipSeconds_) > settings_.lostSeconds)) {
        tipMetres_.reset();
        history_.clear();
    }
    if (!tipMetres_) {
        return false;
    }
    const TipStep step = history_.add(nowSeconds_, *tipMetres_);
    statistics_.clockRestarts += step == TipStep::clockRestarted ? 1 : 0;
    if (step != TipStep::continued) {
        forgetContinuity();
        transitions_.forget();
        pathStart_.reset();
    }
    return true;
}

/// Adds this frame to the path over the surface that was touched in the last frame.
void ContactTracker::continuePath() {
    if (!touched_ || touched_ != pathSurface_) {
        pathSurface_.reset();
        return;
    }
    const glm::dvec3 local = scene_.surfaces[*touched_].poseAt(nowSeconds_).pointToLocal(*tipMetres_);
    const TipStep step = path_.add(nowSeconds_, local, *tipMetres_);
    if (step == TipStep::jumped) {
        ++statistics_.teleports;
        forgetContinuity();
        transitions_.forget();
    }
}

/// Makes the path over another surface of the tip's last positions and of where that surface was then.
void ContactTracker::followPath(std::size_t surface) {
    if (pathSurface_ == surface) {
        return;
    }
    pathSurface_ = surface;
    path_.clear();
    for (const TimedPlace& tip : history_.frames()) {
        const glm::dvec3 local = scene_.surfaces[surface].poseAt(tip.timeSeconds).pointToLocal(tip.placeMetres);
        path_.add(tip.timeSeconds, local, tip.placeMetres);
    }
}

void ContactTracker::forgetContinuity() noexcept {
    localNormal_.reset();
    if (touched_) {
        frames_[*touched_].reset();
    }
}

std::optional<ContactTracker::Candidate> ContactTracker::query(std::size_t surface) {
    const Pose pose = scene_.surfaces[surface].poseAt(nowSeconds_);
    const glm::dvec3 tip = pose.pointToLocal(*tipMetres_);
    const std::optional<glm::dvec3> from = pathInto(surface, pose);
    if (!from && touched_ != surface && !broadPhase_.reaches(surface, tip)) {
        ++statistics_.surfacesRuledOut;
        return std::nullopt;
    }
    ++statistics_.surfaceQueries;
    const Shape& shape = scene_.surfaces[surface].shape;
    const std::optional<SurfaceEntry> entry = from ? entryInto(shape, *from, tip) : std::nullopt;
    std::optional<SurfacePoint> local = closestPoint(surface, tip, entry);
    if (touched_ != surface && entry && (!local || local->beyondMetres > 0.0 || local->signedDistanceMetres > 0.0)) {
        // The tip came out again within the frame: it touched where it went in.
        local = SurfacePoint{entry->pointMetres, entry->normal, glm::dot(tip - entry->pointMetres, entry->normal),
                             std::numeric_limits<double>::infinity()};
    }
    if (!local) {
        return std::nullopt;
    }
    Candidate candidate{surface, *local, pose, scene_.tipRadiusMetres - local->signedDistanceMetres};
    if (entry) {
        candidate.entryShare = entry->share;
    }
    return candidate;
}

/// The previous position of the tip in the surface's own frame, if the tip's way from there may have led through the
/// surface. Empty after a jump of the tip or of the surface.
std::optional<glm::dvec3> ContactTracker::pathInto(std::size_t surface, const Pose& pose) const {
    if (!pathStart_) {
        return std::nullopt;
    }
    const Pose before = scene_.surfaces[surface].poseAt(pathStart_->timeSeconds);
    const glm::dvec3 from = before.pointToLocal(pathStart_->placeMetres);
    const double metres = glm::distance(from, pose.pointToLocal(*tipMetres_));
    const VelocitySettings& velocity = settings_.velocity;
    double speedBefore = std::numeric_limits<double>::infinity();
    if (pathBefore_) {
        const glm::dvec3 earlier =
            scene_.surfaces[surface].poseAt(pathBefore_->timeSeconds).pointToLocal(pathBefore_->placeMetres);
        speedBefore = glm::distance(earlier, from) /
                      std::max(pathStart_->timeSeconds - pathBefore_->timeSeconds, velocity.minimumJumpSeconds);
    }
    const bool isJump = velocity.isJump(metres, nowSeconds_ - pathStart_->timeSeconds, speedBefore);
    return !isJump && broadPhase_.passes(surface, pathStart_->placeMetres, before, *tipMetres_, pose)
               ? std::optional(from)
               : std::nullopt;
}

std::optional<SurfacePoint> ContactTracker::closestPoint(std::size_t surface, const glm::dvec3& localTip,
                                                         const std::optional<SurfaceEntry>& entry) const {
    QueryOptions options{std::nullopt, !touched_ || (touched_ == surface && beganHere_), settings_.switchMarginMetres,
                         settings_.openMeshDepthMetres};
    if (entry) {
        options.previousNormal = entry->normal;
        // Only what is already touched has a face to stay on.
        options.faceMarginMetres = touched_ == surface ? settings_.switchMarginMetres : 0.0;
    } else if (touched_ == surface) {
        options.previousNormal = localNormal_;
    }
    return closestSurfacePoint(scene_.surfaces[surface].shape, localTip, options);
}

/// Visits the contact with every surface but the touched one that is near the tip or that it passed since the previous
/// frame.
template <typename Visit>
void ContactTracker::visitOthers(Visit&& visit) {
    const glm::dvec3 from = pathStart_ ? pathStart_->placeMetres : *tipMetres_;
    const auto consider = [&](std::size_t surface) {
        const std::optional<Candidate> candidate = touched_ != surface ? query(surface) : std::nullopt;
        if (candidate) {
            visit(*candidate);
        }
    };
    broadPhase_.visitNear(0.5 * (from + *tipMetres_), consider, 0.5 * glm::distance(from, *tipMetres_));
}

ContactTracker::Nearby ContactTracker::findNearby() {
    Nearby nearby;
    if (touched_) {
        nearby.current = query(*touched_);
    }
    visitOthers([&](const Candidate& candidate) {
        const bool isInside = candidate.local.beyondMetres == 0.0;
        if (isInside && (!nearby.deepest || candidate.isDeeperThan(*nearby.deepest))) {
            nearby.deepest = candidate;
        }
        if (candidate.penetrationMetres > 0.0 && (!nearby.first || candidate.isMetBefore(*nearby.first))) {
            nearby.first = candidate;
        }
    });
    return nearby;
}

/// Whether the tip came out of the touched surface's far side: it did not if it is in another surface that is so near
/// to that side that the tip was never free between the two.
bool ContactTracker::hasLeft(const Candidate& current) {
    const double freeMetres = scene_.tipRadiusMetres + settings_.releaseDistanceMetres;
    if (current.local.beyondMetres <= freeMetres) {
        return false;
    }
    const glm::dvec3 normal = current.pose.directionToWorld(current.local.normal);
    const glm::dvec3 farSide = *tipMetres_ + current.local.beyondMetres * normal;
    bool isInNext = false;
    visitOthers([&](const Candidate& other) {
        if (other.penetrationMetres > 0.0 && other.local.beyondMetres == 0.0) {
            const auto next = closestPoint(other.surface, other.pose.pointToLocal(farSide));
            isInNext |= next && next->signedDistanceMetres <= scene_.tipRadiusMetres + freeMetres;
        }
    });
    return !isInNext;
}

/// Whether the tip, moved out of the touched surface until it just rests on it, would touch the other one.
bool ContactTracker::isAheadAtRest(const Candidate& current, const Candidate& other) const {
    const glm::dvec3 normal = current.pose.directionToWorld(current.local.normal);
    const glm::dvec3 tip = *tipMetres_ + std::max(0.0, current.penetrationMetres) * normal;
    const auto atRest = closestPoint(other.surface, other.pose.pointToLocal(tip));
    return atRest && scene_.tipRadiusMetres - atRest->signedDistanceMetres - std::min(0.0, current.penetrationMetres) >
                         settings_.switchMarginMetres;
}

std::optional<ContactTracker::Candidate> ContactTracker::chooseContact() {
    const Nearby nearby = findNearby();
    const std::optional<Candidate>& current = nearby.current;
    if (!current || current->penetrationMetres < -settings_.releaseDistanceMetres || hasLeft(*current)) {
        // A tip that slides from one surface to another one touches where it is, not what it passed on the way.
        const bool isIn = touched_ && nearby.deepest && nearby.deepest->penetrationMetres > 0.0;
        return isIn ? nearby.deepest : nearby.first;
    }
    const auto isAhead = [&](const Candidate& other) {
        return other.penetrationMetres > 0.0 &&
               other.penetrationMetres - current->penetrationMetres > settings_.switchMarginMetres;
    };
    if (!nearby.deepest || !isAhead(*nearby.deepest)) {
        return current;
    }
    std::optional<Candidate> next;
    visitOthers([&](const Candidate& other) {
        if (other.local.beyondMetres == 0.0 && isAhead(other) && (!next || other.isDeeperThan(*next)) &&
            isAheadAtRest(*current, other)) {
            next = other;
        }
    });
    return next ? next : current;
}

/// Visits every surface that the tip could touch at its present position.
template <typename Visit>
void ContactTracker::visitWithinReach(Visit&& visit) const {
    const double reachMetres = scene_.tipRadiusMetres + settings_.releaseDistanceMetres;
    broadPhase_.visitNear(*tipMetres_, [&](std::size_t surface) {
        const Pose pose = scene_.surfaces[surface].poseAt(nowSeconds_);
        const auto atTip = closestPoint(surface, pose.pointToLocal(*tipMetres_));
        if (atTip && atTip->signedDistanceMetres <= reachMetres) {
            visit(surface, pose);
        }
    });
}

/// The place where a tip at rest would have the deepest contact.
PosedPlace ContactTracker::restingPlace(const PosedPlace& place, const glm::dvec3& restingTip) const {
    std::optional<Candidate> deepest;
    visitWithinReach([&](std::size_t surface, const Pose& pose) {
        if (const auto local = closestPoint(surface, pose.pointToLocal(restingTip))) {
            const Candidate candidate{surface, *local, pose, -local->signedDistanceMetres};
            if (!deepest || candidate.isDeeperThan(*deepest)) {
                deepest = candidate;
            }
        }
    });
    return deepest ? PosedPlace{deepest->surface, {deepest->local.pointMetres, deepest->local.normal}, deepest->pose}
                   : place;
}

bool ContactTracker::isCaught(std::size_t reference, const Pose& referencePose, const glm::dvec3& restingTip) const {
    bool caught = false;
    visitWithinReach([&](std::size_t surface, const Pose& pose) {
        if (surface != reference && !caught) {
            const auto local = closestPoint(surface, pose.pointToLocal(restingTip));
            caught = local && transitions_.isCaughtBy({surface, {local->pointMetres, local->normal}, pose},
                                                      referencePose, restingTip);
        }
    });
    return caught;
}

void ContactTracker::noteTransition(PosedPlace place, const glm::dvec3& velocityMps) {
    const std::optional<std::size_t> reference = transitions_.referenceSurface();
    const Pose referencePose = reference ? scene_.surfaces[*reference].poseAt(nowSeconds_) : place.pose;
    if (transitions_.isElsewhere(place, referencePose)) {
        const glm::dvec3 tip = transitions_.restingTip(*tipMetres_, referencePose);
        const bool wasElsewhere = place.surface != *reference;
        place = restingPlace(place, tip);
        const bool isElsewhere = place.surface != *reference;
        // The tip still touches the old surface although it would rest on the new one: the change follows when the
        // contact itself changes.
        const bool isEarly = isElsewhere && !wasElsewhere;
        if (isEarly || (!isElsewhere && isCaught(*reference, referencePose, tip))) {
            return;
        }
    }
    const double approachSpeedMps =
        std::max(0.0, -glm::dot(velocityMps, place.pose.directionToWorld(place.local.normal)));
    const ContactEvent event = transitions_.advance(place, referencePose, approachSpeedMps);
    if (event.landed) {
        ++landingCounter_;
        approachSpeedMps_ = approachSpeedMps;
    }
    countEdge(event.edgeHeightMetres);
}

/// Called after a touch, while the touched surface is still known.
void ContactTracker::noteSlideOff() {
    const std::optional<std::size_t> reference = transitions_.referenceSurface();
    if (touched_ && reference == touched_) {
        const Pose pose = scene_.surfaces[*touched_].poseAt(nowSeconds_);
        const auto nearest = closestPoint(*touched_, pose.pointToLocal(*tipMetres_));
        if (nearest && !isCaught(*touched_, pose, transitions_.restingTip(*tipMetres_, pose))) {
            const PosedPlace place{*touched_, {nearest->pointMetres, nearest->normal}, pose};
            countEdge(transitions_.slideOff(place, pose, *tipMetres_, settings_.releaseDistanceMetres));
        }
    }
    transitions_.forget();
}

void ContactTracker::countEdge(double heightMetres) noexcept {
    if (heightMetres > 0.0) {
        ++edgeCounter_;
        edgeHeightMetres_ = heightMetres;
    }
}

ContactReading ContactTracker::describe(const Candidate& contact, bool touchDown, const TipSample& sample) {
    const glm::dvec3 normal = unitOr(contact.pose.directionToWorld(contact.local.normal), {0.0, 1.0, 0.0});
    followPath(contact.surface);
    const auto [localVelocity, localApproach] = relativeVelocity(path_);
    const glm::dvec3 velocity = contact.pose.directionToWorld(localVelocity);
    const glm::dvec3 approach = contact.pose.directionToWorld(localApproach);
    const TangentAxes& axes = frames_[contact.surface].update(contact.local.normal, stepSeconds_);
    localNormal_ = contact.local.normal;
    if (touchDown) {
        ++touchCounter_;
        ++statistics_.touchDowns;
        approachSpeedMps_ = std::max(0.0, -glm::dot(approach, normal));
        transitions_.forget();
    }
    noteTransition({contact.surface, {contact.local.pointMetres, contact.local.normal}, contact.pose}, approach);

    ContactReading reading = idle();
    reading.touching = true;
    reading.surfaceIndex = static_cast<int>(contact.surface);
    reading.pointMetres = contact.pose.pointToWorld(contact.local.pointMetres);
    reading.normal = normal;
    reading.penetrationMetres = std::max(0.0, contact.penetrationMetres);
    reading.tangentialVelocityMps = {glm::dot(velocity, contact.pose.directionToWorld(axes.first)),
                                     glm::dot(velocity, contact.pose.directionToWorld(axes.second))};
    reading.approachSpeedMps = approachSpeedMps_;
    reading.placeMetres = contact.local.pointMetres;
    reading.firstAxis = axes.first;
    reading.secondAxis = axes.second;
    const double spring = stiffnessNewtonsPerMetre_[contact.surface] * reading.penetrationMetres;
    const bool measured = sample.forceNewtons && std::isfinite(*sample.forceNewtons);
    reading.forceNewtons = std::clamp(measured ? *sample.forceNewtons : spring, 0.0, settings_.maximumForceNewtons);
    return reading;
}

ContactReading ContactTracker::idle() const noexcept {
    ContactReading reading;
    reading.timeSeconds = nowSeconds_;
    reading.touchCounter = touchCounter_;
    reading.landingCounter = landingCounter_;
    reading.edgeCounter = edgeCounter_;
    reading.edgeHeightMetres = edgeHeightMetres_;
    reading.pointMetres = tipMetres_.value_or(glm::dvec3(0.0));
    return reading;
}

}  // namespace haptoflow::headless
