#pragma once

#include "headless/contact_transitions.hpp"
#include "headless/contact_types.hpp"
#include "headless/pose.hpp"
#include "headless/scene.hpp"
#include "headless/tip_path.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace haptoflow::headless {

/// Tracks one stylus tip in a scene and reports, frame by frame, what it touches. Not thread-safe.
///
/// A touch begins when the tip sphere penetrates a surface, or passes through one between two frames, and ends when the
/// gap exceeds `releaseDistanceMetres`. Among several surfaces the one that the tip's path entered first is touched,
/// else the deepest. Another surface replaces the touched one only if it is deeper by `switchMarginMetres`, and still
/// would be for a tip that rests on the touched one: what lies below a thin mat does not replace it, a wall beside it
/// does. Inside a shape the face that was entered is held (see QueryOptions), and beyond the far side of a thin shape,
/// too, while the tip is in another surface there. Among equally deep surfaces the first one of the scene wins.
///
/// Velocity, place and jumps are those of the tip in the frame of what it touches: see TipPath.
///
/// A frame computes distances only for surfaces near the tip (see BroadPhase) and allocates nothing.
class ContactTracker {
public:
    /// Every shape has an extent, as parseScene requires.
    explicit ContactTracker(Scene scene, ContactSettings settings = {});

    /// Processes the next frame. A sample with an unusable position keeps the last one for `lostSeconds`. A
    /// time that stands still updates the geometry only. A time that goes backwards, a pause and a jump discard the
    /// tip's earlier positions: the velocity is then zero until the next frame.
    ContactReading update(const TipSample& sample);

    [[nodiscard]] const ContactStatistics& statistics() const noexcept { return statistics_; }
    [[nodiscard]] const Scene& scene() const noexcept { return scene_; }

private:
    struct Candidate {
        std::size_t surface = 0;
        SurfacePoint local;
        Pose pose;
        double penetrationMetres = 0.0;
        /// The part of the tip's last way before it entered the surface; more than 1 if it did not.
        double entryShare = 2.0;

        /// A total order, so that the result does not depend on the order of the search.
        [[nodiscard]] bool isDeeperThan(const Candidate& other) const noexcept {
            return penetrationMetres > other.penetrationMetres ||
                   (penetrationMetres == other.penetrationMetres && surface < other.surface);
        }
        [[nodiscard]] bool isMetBefore(const Candidate& other) const noexcept {
            return entryShare < other.entryShare || (entryShare == other.entryShare && isDeeperThan(other));
        }
    };
    struct Nearby {
        std::optional<Candidate> current;
        /// The deepest other surface.
        std::optional<Candidate> deepest;
        /// The other surface that the tip entered first.
        std::optional<Candidate> first;
    };

    [[nodiscard]] bool acceptSample(const TipSample& sample);
    void continuePath();
    void followPath(std::size_t surface);
    void forgetContinuity() noexcept;
    [[nodiscard]] std::optional<Candidate> query(std::size_t surface);
    [[nodiscard]] std::optional<glm::dvec3> pathInto(std::size_t surface, const Pose& pose) const;
    [[nodiscard]] std::optional<SurfacePoint> closestPoint(
        std::size_t surface, const glm::dvec3& localTip, const std::optional<SurfaceEntry>& entry = std::nullopt) const;
    template <typename Visit>
    void visitOthers(Visit&& visit);
    [[nodiscard]] Nearby findNearby();
    [[nodiscard]] bool hasLeft(const Candidate& current);
    [[nodiscard]] bool isAheadAtRest(const Candidate& current, const Candidate& other) const;
    [[nodiscard]] std::optional<Candidate> chooseContact();
    template <typename Visit>
    void visitWithinReach(Visit&& visit) const;
    [[nodiscard]] PosedPlace restingPlace(const PosedPlace& place, const glm::dvec3& restingTip) const;
    [[nodiscard]] bool isCaught(std::size_t reference, const Pose& referencePose, const glm::dvec3& restingTip) const;
    void noteTransition(PosedPlace place, const glm::dvec3& velocityMps);
    void noteSlideOff();
    void countEdge(double heightMetres) noexcept;
    [[nodiscard]] ContactReading describe(const Candidate& contact, bool touchDown, const TipSample& sample);
    [[nodiscard]] ContactReading idle() const noexcept;

    Scene scene_;
    ContactSettings settings_;
    BroadPhase broadPhase_;
    std::vector<double> stiffnessNewtonsPerMetre_;
    std::vector<TangentFrame> frames_;
    TipHistory history_;
    // Over the surface that was touched last, while it is touched.
    TipPath path_;
    std::optional<std::size_t> pathSurface_;
    ContactStatistics statistics_;

    double nowSeconds_ = 0.0;
    double stepSeconds_ = 0.0;
    bool started_ = false;
    std::optional<glm::dvec3> tipMetres_;
    double tipSeconds_ = 0.0;
    /// Where the tip was one frame ago, and two frames ago; empty if it was nowhere then.
    std::optional<TimedPlace> pathStart_;
    std::optional<TimedPlace> pathBefore_;

    std::optional<std::size_t> touched_;
    /// The touch began on the touched surface.
    bool beganHere_ = false;
    std::optional<glm::dvec3> localNormal_;
    std::uint32_t touchCounter_ = 0;
    double approachSpeedMps_ = 0.0;
    ContactTransitions transitions_;
    std::uint32_t landingCounter_ = 0;
    std::uint32_t edgeCounter_ = 0;
    double edgeHeightMetres_ = 0.0;
};

}  // namespace haptoflow::headless
