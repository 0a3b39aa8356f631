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
    /// A measurement of its own; otherwise the tracker repeated its last one.
    bool fresh = true;
};

/// How a frame follows the last.
enum class TipStep {
    started,
    continued,
    /// Too far in too short a time.
    teleported,
    /// The time went backwards.
    clockRestarted,
    /// After a pause so long that the past says nothing.
    resumed,
};

/// The last tenth of a second of the tip, with tracker hold told from stops.
///
/// A tracker slower than the frame rate repeats positions. Repeats are no measurements and stay out of the
/// velocity until `stopSeconds`; then the tip has really stopped and all of them were measurements.
class TipHistory {
public:
    static constexpr std::size_t capacity = 256;

    explicit TipHistory(const VelocitySettings& settings);

    /// Time and position must be usable. Whatever the answer but `continued`, the past is gone.
    TipStep add(double timeSeconds, const glm::dvec3& positionMetres);
    void clear() noexcept;

    /// Oldest first.
    [[nodiscard]] std::span<const TipFrame> frames() const noexcept { return frames_; }
    /// How far the last measurement's velocity still holds now: 1 up to `holdSeconds` after it, 0 from `stopSeconds`.
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
