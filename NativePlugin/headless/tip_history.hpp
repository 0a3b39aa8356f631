#pragma once

#include "headless/contact_types.hpp"

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
class TipHistory {
public:
    static constexpr std::size_t capacity = 256;

    explicit TipHistory(const VelocitySettings& settings);

    /// Adds a frame; time and position must be usable. Every result but `continued` means that the history was dropped.
    TipStep add(double timeSeconds, const glm::dvec3& positionMetres);
    void clear() noexcept;

    /// Oldest first.
    [[nodiscard]] std::span<const TipFrame> frames() const noexcept { return frames_; }
    /// Weight of the last measurement's velocity: 1 up to `holdSeconds` after it, 0 from `stopSeconds` on.
    [[nodiscard]] double confidence() const noexcept;
    [[nodiscard]] const VelocitySettings& settings() const noexcept { return settings_; }

private:
    TipStep start(TipStep step, double timeSeconds, const glm::dvec3& positionMetres);
    void confirmStop(double timeSeconds);

    VelocitySettings settings_;
    std::vector<TipFrame> frames_;
    double latestSeconds_ = 0.0;
    double measuredSeconds_ = 0.0;
    glm::dvec3 measuredMetres_{0.0};
    bool resting_ = false;
};

}  // namespace haptoflow::headless
