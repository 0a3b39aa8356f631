#pragma once

#include "headless/bounds.hpp"
#include "headless/pose.hpp"

#include <cstddef>
#include <vector>

namespace haptoflow::headless {

/// A pose at a time on the stroke's clock.
struct Keyframe {
    double timeSeconds = 0.0;
    Pose pose;
};

/// A path through keyframes. Positions follow a cubic spline through the keyframes with continuous velocity. Rotations
/// turn the shorter way at a constant rate between two keyframes, so that neighbouring rotations must differ by less
/// than half a turn. The object rests before the first keyframe and after the last. A loop starts again instead and
/// should end in the pose that it began with.
class Motion {
public:
    /// Throws std::invalid_argument unless there are at least two keyframes with usable, strictly increasing times.
    Motion(std::vector<Keyframe> keyframes, bool loop);

    [[nodiscard]] Pose poseAt(double timeSeconds) const noexcept;
    /// A box around every position on the path, in metres, up to rounding.
    [[nodiscard]] Bounds bounds() const noexcept;
    [[nodiscard]] const std::vector<Keyframe>& keyframes() const noexcept { return keyframes_; }
    [[nodiscard]] bool loops() const noexcept { return loop_; }

private:
    [[nodiscard]] glm::dvec3 chordVelocity(std::size_t from, std::size_t to) const noexcept;
    [[nodiscard]] glm::dvec3 velocityAtKeyframe(std::size_t index) const noexcept;

    std::vector<Keyframe> keyframes_;
    bool loop_;
    bool closed_ = false;
};

}  // namespace haptoflow::headless
