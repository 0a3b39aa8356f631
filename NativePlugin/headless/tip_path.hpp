#pragma once

#include "headless/contact_types.hpp"

#include <array>
#include <cstddef>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace haptoflow::headless {

/// Where the tip was at a time.
struct TimedPlace {
    double timeSeconds = 0.0;
    glm::dvec3 placeMetres{0.0};
};

/// Places at times, and the velocity at the newest of them.
///
/// A parabola is fitted by least squares to the newest places, to as many as agree with it: adaptive windowing of
/// second order (Janabi-Sharifi, Hayward, Chen 2000). The window ends where a cubic would fit better by more than noise
/// explains, which is sooner noticed than a place outside a band. The derivative is taken at the newest place, so that
/// nothing lags; what noise alone can explain of the curvature is left out (James and Stein 1961), so that a tip at
/// rest or in steady motion has no more noise than a straight line gives.
class GrowingFit {
public:
    static constexpr std::size_t capacity = 64;

    /// Newest first; not when full.
    void add(double timeSeconds, const glm::dvec3& placeMetres) noexcept;

    [[nodiscard]] std::size_t count() const noexcept { return count_; }
    [[nodiscard]] bool full() const noexcept { return count_ == capacity; }
    [[nodiscard]] double newestSeconds() const noexcept { return entries_[0].timeSeconds; }
    [[nodiscard]] double oldestSeconds() const noexcept { return entries_[count_ - 1].timeSeconds; }
    [[nodiscard]] const glm::dvec3& oldestMetres() const noexcept { return entries_[count_ - 1].placeMetres; }

    /// m/s, with the noise of a place on each axis; zero with fewer than two places.
    [[nodiscard]] glm::dvec3 endVelocity(double noiseMetres) const noexcept;

    /// m/s, the mean over the last `seconds`, over three places at least; zero with fewer than two places.
    [[nodiscard]] glm::dvec3 meanVelocity(double seconds) const noexcept;

private:
    struct Fit {
        glm::dvec3 endVelocityMps{0.0};
        bool agrees = true;
    };

    [[nodiscard]] Fit fitNewest(std::size_t size, double noiseMetres) const noexcept;

    std::array<TimedPlace, capacity> entries_{};
    std::size_t count_ = 0;
};

/// How noisy a tracker's places are, from the places themselves.
///
/// A hand moves smoothly over four measurements, so that their third difference is mostly noise. A sudden movement
/// makes it larger for a moment. The estimate therefore follows a low quantile, which such moments hardly change, by
/// small steps (Robbins and Monro 1951).
class TrackerNoise {
public:
    /// On each axis.
    [[nodiscard]] double metres() const noexcept { return metres_; }

    /// Forgets the measurements, not what was learnt from them.
    void restart() noexcept { count_ = 0; }

    /// A new measurement, in the frame after the last one's.
    void add(double timeSeconds, const glm::dvec3& placeMetres) noexcept;

private:
    std::array<TimedPlace, 4> newest_{};
    std::size_t count_ = 0;
    double metres_ = 50e-6;
};

/// The tip at one frame.
struct TipFrame {
    double timeSeconds = 0.0;
    /// In the surface's coordinates.
    glm::dvec3 positionMetres{0.0};
    /// True for a new measurement, false if the tracker repeated its last one.
    bool fresh = true;
    /// Speed since the measurement before; infinite if it is not known.
    double speedMps = 0.0;
};

/// How a frame relates to the previous one.
enum class TipStep {
    started,
    continued,
    /// No hand makes this way in the time; see `TipPath`.
    jumped,
    /// The time went backwards.
    clockRestarted,
    /// After a pause so long that the path is dropped.
    resumed,
};

/// The tip's recent positions in the coordinates of one surface, where motion that both share, as in a lift, does not
/// show. Distinguishes positions that the tracker holds from stops, and jumps from strokes.
///
/// A tracker slower than the frame rate repeats positions, in the world or, if the tip is carried, on the surface.
/// Repeated positions are not measurements and are excluded from the velocity until `stopSeconds`; after that, and not
/// with the first repetition, the tip has really stopped, and all of them count as measurements. A tracker that has
/// measured in 32 frames in a row is trusted not to repeat positions: the first position that it repeats halves the
/// weight of the velocity, and the second in a row is a stop. A tracker that has repeated positions and is not trusted
/// since is slow: its positions may be older than the frames that report them, by up to a frame.
///
/// A step is a jump (a teleport, a snap turn, tracking regained) if it is faster than `maximumSpeedMps`, or faster than
/// the last measurements by more than a hand can accelerate in the time: VelocitySettings::maximumGainMps. A tip that
/// is stopped, however hard, has not jumped.
class TipPath {
public:
    static constexpr std::size_t capacity = 256;

    explicit TipPath(const VelocitySettings& settings);

    /// Adds a frame; time and positions must be usable. Every result but `continued` means that the path was dropped.
    TipStep add(double timeSeconds, const glm::dvec3& surfaceMetres, const glm::dvec3& worldMetres);
    void clear() noexcept;

    /// Oldest first.
    [[nodiscard]] std::span<const TipFrame> frames() const noexcept { return frames_; }
    /// Noise of the positions on each axis; learnt, and kept when the path is cleared.
    [[nodiscard]] double noiseMetres() const noexcept { return noise_.metres(); }
    /// True if the tracker repeated itself within its last measurements.
    [[nodiscard]] bool isSlow() const noexcept { return hasRepeated_ && !isTrusted(); }
    /// Weight of the last measurement's velocity: 1 up to the hold time after it, 0 from the stop time on.
    [[nodiscard]] double confidence() const noexcept;
    [[nodiscard]] double measuredSeconds() const noexcept { return measuredSeconds_; }
    [[nodiscard]] const VelocitySettings& settings() const noexcept { return settings_; }

private:
    TipStep start(TipStep step, double timeSeconds, const glm::dvec3& surfaceMetres, const glm::dvec3& worldMetres,
                  double speedMps);
    [[nodiscard]] bool isJump(double moved, double seconds, bool isHeld) const noexcept;
    void confirmStop(double timeSeconds);
    void measure(double timeSeconds, const glm::dvec3& surfaceMetres, double frameSeconds);
    [[nodiscard]] bool isTrusted() const noexcept;
    [[nodiscard]] double holdSeconds() const noexcept;
    [[nodiscard]] double stopSeconds() const noexcept;

    VelocitySettings settings_;
    TrackerNoise noise_;
    std::vector<TipFrame> frames_;
    double latestSeconds_ = 0.0;
    double measuredSeconds_ = 0.0;
    glm::dvec3 measuredMetres_{0.0};
    glm::dvec3 measuredWorldMetres_{0.0};
    double movedSeconds_ = 0.0;
    double moveSeconds_ = 0.0;
    std::size_t measurementsInRow_ = 0;
    std::size_t repeatsInRow_ = 0;
    bool hasRepeated_ = false;
    bool resting_ = false;
};

/// The tip's last positions in the world, of which the path over a surface is made when the tip comes to it. Whether a
/// step is a jump only a surface can tell.
class TipHistory {
public:
    static constexpr std::size_t capacity = 64;

    explicit TipHistory(const VelocitySettings& settings);

    /// Adds a frame; time and position must be usable. Every result but `continued` means that the history was dropped.
    TipStep add(double timeSeconds, const glm::dvec3& worldMetres);
    void clear() noexcept { frames_.clear(); }
    /// Oldest first.
    [[nodiscard]] std::span<const TimedPlace> frames() const noexcept { return frames_; }

private:
    VelocitySettings settings_;
    std::vector<TimedPlace> frames_;
    double latestSeconds_ = 0.0;
};

/// The surface's axes, m/s, of the tip relative to the surface.
struct RelativeVelocity {
    /// At the newest measurement, for what is felt now.
    glm::dvec3 nowMps{0.0};
    /// Mean of the last approachSeconds: how the tip came to where it is, for what it meets there.
    glm::dvec3 approachMps{0.0};
};

/// Velocity of the tip's path over a surface, by GrowingFit. A tip that moves along with a surface has zero velocity,
/// and under a tip at rest a turning surface gives its linear velocity plus angular velocity x arm. If the tracker
/// repeats a position for longer than the hold time, the velocity fades to that of a tip which is held there: zero on a
/// surface at rest. The magnitude is limited to the maximum speed; it is zero with fewer than two measurements.
[[nodiscard]] RelativeVelocity relativeVelocity(const TipPath& path);

}  // namespace haptoflow::headless
