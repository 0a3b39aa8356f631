#include "headless/contact_tracker.hpp"

#include "headless/relative_velocity.hpp"
#include "headless/vectors.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>

namespace haptoflow::headless {
namespace {

// Limits how far carried tangent axes turn after a pause: no further than in a slow frame.
constexpr double maximumFrameSeconds = 0.05;

void require(bool holds, const char* expectation) {
    if (!holds) {
        throw std::invalid_argument(std::string("contact: ") + expectation);
    }
}

bool positive(double value) {
    return value > 0.0 && isUsable(value);
}

bool notNegative(double value) {
    return value >= 0.0 && isUsable(value);
}

bool hasExtent(const Shape& shape) {
    if (const auto* box = std::get_if<Box>(&shape)) {
        return positive(box->sizeMetres.x) && positive(box->sizeMetres.y) && positive(box->sizeMetres.z);
    }
    if (const auto* sphere = std::get_if<Sphere>(&shape)) {
        return positive(sphere->radiusMetres);
    }
    if (const auto* capsule = std::get_if<Capsule>(&shape)) {
        return positive(capsule->radiusMetres) && positive(capsule->heightMetres);
    }
    const auto* mesh = std::get_if<std::shared_ptr<const TriangleMesh>>(&shape);
    return mesh == nullptr || *mesh != nullptr;
}

/// Returns the scene after checking that it and the settings are in range.
Scene checked(Scene scene, const ContactSettings& settings) {
    const VelocitySettings& velocity = settings.velocity;
    require(notNegative(scene.tipRadiusMetres), "tipRadiusMetres must be 0 or more");
    require(positive(settings.maximumForceNewtons), "maximumForceNewtons must be above 0");
    require(positive(settings.defaultStiffnessNewtonsPerMetre), "defaultStiffnessNewtonsPerMetre must be above 0");
    require(notNegative(settings.releaseDistanceMetres), "releaseDistanceMetres must be 0 or more");
    require(notNegative(settings.switchMarginMetres), "switchMarginMetres must be 0 or more");
    require(notNegative(settings.openMeshDepthMetres), "openMeshDepthMetres must be 0 or more");
    require(notNegative(settings.lostSeconds), "lostSeconds must be 0 or more");
    require(positive(velocity.windowSeconds), "windowSeconds must be above 0");
    require(positive(velocity.approachSeconds), "approachSeconds must be above 0");
    require(notNegative(velocity.holdSeconds), "holdSeconds must be 0 or more");
    require(velocity.stopSeconds > velocity.holdSeconds && isUsable(velocity.stopSeconds),
            "stopSeconds must be above holdSeconds");
    require(positive(velocity.maximumGapSeconds), "maximumGapSeconds must be above 0");
    require(positive(velocity.minimumStepSeconds), "minimumStepSeconds must be above 0");
    require(notNegative(velocity.minimumMoveMetres), "minimumMoveMetres must be 0 or more");
    require(positive(velocity.maximumSpeedMps), "maximumSpeedMps must be above 0");
    require(positive(velocity.jumpGainMps), "jumpGainMps must be above 0");
    require(positive(velocity.jumpAccelerationMps2), "jumpAccelerationMps2 must be above 0");
    require(positive(velocity.minimumJumpSeconds), "minimumJumpSeconds must be above 0");
    for (const SceneSurface& surface : scene.surfaces) {
        require(hasExtent(surface.shape), "every shape must have sizes above 0 and every mesh must be there");
    }
    return scene;
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
    : scene_(checked(std::move(scene), settings)),
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
    for (const TipHistory::Frame& frame : history_.frames()) {
        const glm::dvec3 local = scene_.surfaces[surface].poseAt(frame.timeSeconds).pointToLocal(frame.worldMetres);
        path_.add(frame.timeSeconds, local, frame.worldMetres);
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
    if (!broadPhase_.reaches(surface, tip)) {
        ++statistics_.surfacesRuledOut;
        return std::nullopt;
    }
    ++statistics_.surfaceQueries;
    const std::optional<SurfacePoint> local = closestPoint(surface, tip);
    if (!local) {
        return std::nullopt;
    }
    return Candidate{surface, *local, pose, scene_.tipRadiusMetres - local->signedDistanceMetres};
}

std::optional<SurfacePoint> ContactTracker::closestPoint(std::size_t surface, const glm::dvec3& localTip) const {
    QueryOptions options{std::nullopt, settings_.switchMarginMetres, settings_.openMeshDepthMetres};
    if (touched_ == surface) {
        options.previousNormal = localNormal_;
    }
    return closestSurfacePoint(scene_.surfaces[surface].shape, localTip, options);
}

ContactTracker::Nearby ContactTracker::findNearby() {
    Nearby nearby;
    broadPhase_.visitNear(*tipMetres_, [&](std::size_t surface) {
        const std::optional<Candidate> candidate = query(surface);
        if (!candidate) {
            return;
        }
        if (touched_ == surface) {
            nearby.current = candidate;
        }
        if (!nearby.deepest || candidate->isDeeperThan(*nearby.deepest)) {
            nearby.deepest = candidate;
        }
    });
    return nearby;
}

std::optional<ContactTracker::Candidate> ContactTracker::chooseContact() {
    const Nearby nearby = findNearby();
    const bool kept = nearby.current && nearby.current->penetrationMetres >= -settings_.releaseDistanceMetres;
    if (!nearby.deepest || nearby.deepest->penetrationMetres <= 0.0) {
        return kept ? nearby.current : std::nullopt;
    }
    const double lead =
        kept ? nearby.deepest->penetrationMetres - nearby.current->penetrationMetres : settings_.switchMarginMetres;
    return kept && lead <= settings_.switchMarginMetres ? nearby.current : nearby.deepest;
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
