#pragma once

#include "headless/contact_tracker.hpp"
#include "headless/relative_velocity.hpp"
#include "headless/tip_history.hpp"
#include "headless/vectors.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
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
        last_ = {sample.timeSeconds, false, last_.touchCounter, -1, sample.positionMetres};
        if (history_.add(sample.timeSeconds, sample.positionMetres) != TipStep::continued) {
            forget();
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
    };

    std::optional<Found> query(std::size_t index, const TipSample& sample) const {
        const SceneSurface& surface = scene_.surfaces[index];
        const Pose pose = surface.poseAt(sample.timeSeconds);
        const glm::dvec3 tip = pose.pointToLocal(sample.positionMetres);
        const BoundingSphere sphere = boundingSphere(surface.shape);
        const double reach = scene_.tipRadiusMetres + settings_.releaseDistanceMetres;
        if (glm::distance(tip, sphere.centreMetres) > sphere.radiusMetres + reach) {
            return std::nullopt;
        }
        QueryOptions options{std::nullopt, settings_.switchMarginMetres, settings_.openMeshDepthMetres};
        if (touched_ == index) {
            options.previousNormal = normal_;
        }
        const auto local = closestSurfacePoint(surface.shape, tip, options);
        return local ? std::optional(Found{index, *local, pose, scene_.tipRadiusMetres - local->signedDistanceMetres})
                     : std::nullopt;
    }

    std::optional<Found> choose(const TipSample& sample) {
        std::optional<Found> current;
        std::optional<Found> deepest;
        for (std::size_t index = 0; index < scene_.surfaces.size(); ++index) {
            const std::optional<Found> found = query(index, sample);
            if (found && touched_ == index && found->penetrationMetres >= -settings_.releaseDistanceMetres) {
                current = found;
            }
            if (!found || found->penetrationMetres <= 0.0) {
                continue;
            }
            ties_ += deepest && found->penetrationMetres == deepest->penetrationMetres ? 1 : 0;
            if (!deepest || found->penetrationMetres > deepest->penetrationMetres) {
                deepest = found;
            }
        }
        const bool overtaken = current && deepest &&
                               deepest->penetrationMetres - current->penetrationMetres > settings_.switchMarginMetres;
        return current && !overtaken ? current : deepest;
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
    std::optional<std::size_t> touched_;
    std::optional<glm::dvec3> normal_;
    double approachSpeedMps_ = 0.0;
    int ties_ = 0;
};

}  // namespace haptoflow::headless::testing
