#pragma once

#include "headless/bounds.hpp"
#include "headless/pose.hpp"

#include <cstddef>
#include <vector>

namespace haptoflow::headless {

/// A pose at a time of the stroke's clock.
struct Keyframe {
    double timeSeconds = 0.0;
    Pose pose;
};

/// A path through keyframes. Positions follow a cubic through the keyframes whose velocity is continuous between
/// the first and the last; rotations turn the short way at a constant rate between two keyframes, so neighbours
/// must lie less than half a turn apart. Before the first keyframe and after the last the object rests there;
/// a loop starts again instead, and should end in the pose it began with.
class Motion {
public:
    /// Throws std::invalid_argument unless there are two or more keyframes with usable, strictly increasing times.
    Motion(std::vector<Keyframe> keyframes, bool loop);

    [[nodiscard]] Pose poseAt(double timeSeconds) const noexcept;
    /// Around every position on the path, in metres, give or take rounding.
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
