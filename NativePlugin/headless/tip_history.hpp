#pragma once

#include "headless/contact_types.hpp"
#include "headless/tracker_noise.hpp"

#include <cstddef>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace haptoflow::headless {

/// The tip at one frame.
struct TipFrame {
    double timeSeconds = 0.0;
    glm::dvec3 positionMetres{0.0};
    /// True for a new measurement, false if the tracker repeated its last one.
    bool fresh = true;
};

/// How a frame relates to the previous one.
enum class TipStep {
    started,
    continued,
    /// The tip moved farther than the maximum speed allows.
    teleported,
    /// The time went backwards.
    clockRestarted,
    /// After a pause so long that the history is dropped.
    resumed,
};

/// The tip's positions of the last tenth of a second; distinguishes positions that the tracker holds from stops.
///
/// A tracker slower than the frame rate repeats positions. Repeated positions are not measurements and are excluded
/// from the velocity until `stopSeconds`; after that the tip has really stopped, and all of them count as measurements.
/// A tracker that has measured in 32 frames in a row is trusted not to repeat positions: the first position that it
/// repeats halves the weight of the velocity, and the second in a row is a stop. A tracker that has repeated positions
/// and is not trusted since is slow: its positions may be older than the frames that report them, by up to a frame.
class TipHistory {
public:
    static constexpr std::size_t capacity = 256;

    explicit TipHistory(const VelocitySettings& settings);

    /// Adds a frame; time and position must be usable. Every result but `continued` means that the history was dropped.
    TipStep add(double timeSeconds, const glm::dvec3& positionMetres);
    void clear() noexcept;

    /// Oldest first.
    [[nodiscard]] std::span<const TipFrame> frames() const noexcept { return frames_; }
    /// Noise of the positions on each axis.
    [[nodiscard]] double noiseMetres() const noexcept { return noise_.metres(); }
    /// True if the tracker repeated itself within its last measurements.
    [[nodiscard]] bool isSlow() const noexcept { return hasRepeated_ && !isTrusted(); }
    /// Weight of the last measurement's velocity: 1 up to the hold time after it, 0 from the stop time on.
    [[nodiscard]] double confidence() const noexcept;
    [[nodiscard]] const VelocitySettings& settings() const noexcept { return settings_; }

private:
    TipStep start(TipStep step, double timeSeconds, const glm::dvec3& positionMetres);
    void confirmStop(double timeSeconds);
    void measure(double timeSeconds, const glm::dvec3& positionMetres, double frameSeconds);
    [[nodiscard]] bool isTrusted() const noexcept;
    [[nodiscard]] double holdSeconds() const noexcept;
    [[nodiscard]] double stopSeconds() const noexcept;

    VelocitySettings settings_;
    TrackerNoise noise_;
    std::vector<TipFrame> frames_;
    double latestSeconds_ = 0.0;
    double measuredSeconds_ = 0.0;
    glm::dvec3 measuredMetres_{0.0};
    double movedSeconds_ = 0.0;
    double moveSeconds_ = 0.0;
    std::size_t measurementsInRow_ = 0;
    bool hasRepeated_ = false;
    bool resting_ = false;
};

}  // namespace haptoflow::headless
