#pragma once

#include "headless/contact_tracker.hpp"
#include "headless/relative_velocity.hpp"
#include "headless/tip_history.hpp"
#include "headless/vectors.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

namespace haptoflow::headless::testing {

/// The contact rules without a broad phase: every frame checks every surface whose bounding sphere is within reach. A
/// reference for ContactTracker, for usable samples without a measured force.
class PlainScan {
public:
    explicit PlainScan(Scene scene) : scene_(std::move(scene)) {
        for (const SceneSurface& surface : scene_.surfaces) {
            frames_.emplace_back(surface.grain);
        }
    }

    ContactReading update(const TipSample& sample) {
        const double step = std::clamp(sample.timeSeconds - last_.timeSeconds, 0.0, 0.05);
        earlier_ = before_;
        before_ = hasStarted_ ? std::optional(std::pair(last_.timeSeconds, tip_)) : std::nullopt;
        hasStarted_ = true;
        tip_ = sample.positionMetres;
        last_ = {sample.timeSeconds, false, last_.touchCounter, -1, sample.positionMetres};
        if (history_.add(sample.timeSeconds, sample.positionMetres) != TipStep::continued) {
            forget();
            before_.reset();
        }
        if (touched_ && addToPath(*touched_, sample.timeSeconds, sample.positionMetres) == TipStep::jumped) {
            forget();
        }
        const std::optional<std::size_t> before = touched_;
        touchedBefore_ = touched_;
        const std::optional<Found> contact = choose(sample);
        if (!contact || before != contact->surface) {
            forget();
        }
        if (!contact) {
            touched_.reset();
            return last_;
        }
        beganHere_ = before ? beganHere_ && before == contact->surface : true;
        touched_ = contact->surface;
        describe(*contact, !before, step);
        return last_;
    }

    /// How often two surfaces were equally deep, so that their order decided.
    [[nodiscard]] int ties() const { return ties_; }

private:
    struct Found {
        std::size_t surface;
        SurfacePoint local;
        Pose pose;
        double penetrationMetres;
        double entryShare;
    };

    std::optional<Found> query(std::size_t index, const TipSample& sample) const {
        const SceneSurface& surface = scene_.surfaces[index];
        const Pose pose = surface.poseAt(sample.timeSeconds);
        const glm::dvec3 tip = pose.pointToLocal(sample.positionMetres);
        std::optional<SurfaceEntry> entry;
        if (before_) {
            const glm::dvec3 from = surface.poseAt(before_->first).pointToLocal(before_->second);
            const VelocitySettings& velocity = settings_.velocity;
            double speed = std::numeric_limits<double>::infinity();
            if (earlier_) {
                const glm::dvec3 earlier = surface.poseAt(earlier_->first).pointToLocal(earlier_->second);
                speed = glm::distance(earlier, from) /
                        std::max(before_->first - earlier_->first, velocity.minimumJumpSeconds);
            }
            const bool isJump = velocity.isJump(glm::distance(from, tip), sample.timeSeconds - before_->first, speed);
            entry = isJump ? std::nullopt : entryInto(surface.shape, from, tip);
        }
        QueryOptions options{std::nullopt, !touched_ || (touched_ == index && beganHere_), settings_.switchMarginMetres,
                             settings_.openMeshDepthMetres};
        if (entry) {
            options.previousNormal = entry->normal;
            options.faceMarginMetres = touched_ == index ? settings_.switchMarginMetres : 0.0;
        } else if (touched_ == index) {
            options.previousNormal = normal_;
        }
        auto local = closestSurfacePoint(surface.shape, tip, options);
        if (touched_ != index && entry && (!local || local->beyondMetres > 0.0 || local->signedDistanceMetres > 0.0)) {
            local = SurfacePoint{entry->pointMetres, entry->normal, glm::dot(tip - entry->pointMetres, entry->normal),
                                 std::numeric_limits<double>::infinity()};
        }
        return local ? std::optional(Found{index, *local, pose, scene_.tipRadiusMetres - local->signedDistanceMetres,
                                           entry ? entry->share : 2.0})
                     : std::nullopt;
    }

    /// Signed distance of another surface from the tip, moved out of the present one.
    double distanceAt(double metres, const Found& current, const Found& other) const {
        const glm::dvec3 tip = tip_ + metres * current.pose.directionToWorld(current.local.normal);
        const QueryOptions options{std::nullopt, false, settings_.switchMarginMetres, settings_.openMeshDepthMetres};
        const auto local =
            closestSurfacePoint(scene_.surfaces[other.surface].shape, other.pose.pointToLocal(tip), options);
        return local ? local->signedDistanceMetres : std::numeric_limits<double>::infinity();
    }

    bool hasLeft(const Found& current, const std::vector<Found>& others) const {
        const double beyond = current.local.beyondMetres;
        const double free = scene_.tipRadiusMetres + settings_.releaseDistanceMetres;
        return beyond > free && std::ranges::none_of(others, [&](const Found& other) {
                   return other.local.beyondMetres == 0.0 &&
                          distanceAt(beyond, current, other) <= scene_.tipRadiusMetres + free;
               });
    }

    std::optional<Found> choose(const TipSample& sample) {
        std::optional<Found> current;
        std::vector<Found> others;
        for (std::size_t index = 0; index < scene_.surfaces.size(); ++index) {
            const std::optional<Found> found = query(index, sample);
            if (found && touched_ == index) {
                current = found;
            } else if (found && found->penetrationMetres > 0.0) {
                ties_ +=
                    std::ranges::any_of(
                        others, [&](const Found& each) { return each.penetrationMetres == found->penetrationMetres; })
                        ? 1
                        : 0;
                others.push_back(*found);
            }
        }
        const double release = settings_.releaseDistanceMetres;
        if (current && (current->penetrationMetres < -release || hasLeft(*current, others))) {
            current.reset();
        }
        std::optional<Found> best = current;
        for (const Found& each : others) {
            if (current) {
                const double margin = settings_.switchMarginMetres;
                const bool isAhead =
                    each.local.beyondMetres == 0.0 && each.penetrationMetres - current->penetrationMetres > margin &&
                    scene_.tipRadiusMetres - distanceAt(std::max(0.0, current->penetrationMetres), *current, each) -
                            std::min(0.0, current->penetrationMetres) >
                        margin;
                if (!isAhead ||
                    (best->surface != current->surface && each.penetrationMetres <= best->penetrationMetres)) {
                    continue;
                }
            } else if (best) {
                const auto order = [&](const Found& found) {
                    const bool isPassed = found.local.beyondMetres > 0.0;
                    return std::tuple(touched_ && isPassed, touched_ && !isPassed ? 0.0 : found.entryShare,
                                      -found.penetrationMetres);
                };
                if (order(each) >= order(*best)) {
                    continue;
                }
            }
            best = each;
        }
        return best;
    }

    TipStep addToPath(std::size_t surface, double time, const glm::dvec3& tip) {
        return path_.add(time, scene_.surfaces[surface].poseAt(time).pointToLocal(tip), tip);
    }

    void followPath(std::size_t surface) {
        if (touchedBefore_ != surface) {
            path_.clear();
            for (const TipHistory::Frame& frame : history_.frames()) {
                addToPath(surface, frame.timeSeconds, frame.worldMetres);
            }
        }
    }

    void forget() {
        normal_.reset();
        for (TangentFrame& frame : frames_) {
            frame.reset();
        }
    }

    void describe(const Found& contact, bool touchDown, double stepSeconds) {
        const glm::dvec3 normal = unitOr(contact.pose.directionToWorld(contact.local.normal), {0.0, 1.0, 0.0});
        followPath(contact.surface);
        const auto [localVelocity, localApproach] = relativeVelocity(path_);
        const glm::dvec3 velocity = contact.pose.directionToWorld(localVelocity);
        const glm::dvec3 approach = contact.pose.directionToWorld(localApproach);
        const TangentAxes& axes = frames_[contact.surface].update(contact.local.normal, stepSeconds);
        normal_ = contact.local.normal;
        if (touchDown) {
            ++last_.touchCounter;
            approachSpeedMps_ = std::max(0.0, -glm::dot(approach, normal));
        }
        last_.touching = true;
        last_.surfaceIndex = static_cast<int>(contact.surface);
        last_.pointMetres = contact.pose.pointToWorld(contact.local.pointMetres);
        last_.normal = normal;
        last_.penetrationMetres = std::max(0.0, contact.penetrationMetres);
        last_.tangentialVelocityMps = {glm::dot(velocity, contact.pose.directionToWorld(axes.first)),
                                       glm::dot(velocity, contact.pose.directionToWorld(axes.second))};
        last_.approachSpeedMps = approachSpeedMps_;
        last_.forceNewtons = std::min(settings_.defaultStiffnessNewtonsPerMetre * last_.penetrationMetres,
                                      settings_.maximumForceNewtons);
    }

    Scene scene_;
    ContactSettings settings_;
    TipHistory history_{settings_.velocity};
    TipPath path_{settings_.velocity};
    std::optional<std::size_t> touchedBefore_;
    std::vector<TangentFrame> frames_;
    ContactReading last_;
    bool hasStarted_ = false;
    glm::dvec3 tip_{0.0};
    /// Time and tip of the frame before.
    std::optional<std::pair<double, glm::dvec3>> before_;
    std::optional<std::pair<double, glm::dvec3>> earlier_;
    std::optional<std::size_t> touched_;
    bool beganHere_ = false;
    std::optional<glm::dvec3> normal_;
    double approachSpeedMps_ = 0.0;
    int ties_ = 0;
};

}  // namespace haptoflow::headless::testing
