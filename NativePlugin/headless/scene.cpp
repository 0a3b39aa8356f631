#include "headless/scene.hpp"

#include "headless/pose.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <stdexcept>
#include <utility>

namespace haptoflow::headless {

Motion::Motion(std::vector<Keyframe> keyframes, bool loop) : keyframes_(std::move(keyframes)), loop_(loop) {
    if (keyframes_.size() < 2) {
        throw std::invalid_argument("a motion needs two or more keyframes");
    }
    for (std::size_t index = 0; index < keyframes_.size(); ++index) {
        keyframes_[index].pose = sanitised(keyframes_[index].pose);
        const bool later = index == 0 || keyframes_[index].timeSeconds > keyframes_[index - 1].timeSeconds;
        if (!isUsable(keyframes_[index].timeSeconds) || !later) {
            throw std::invalid_argument("keyframe times must be finite and strictly increasing");
        }
    }
    closed_ =
        loop_ && glm::distance(keyframes_.front().pose.positionMetres, keyframes_.back().pose.positionMetres) < 1e-9;
}

glm::dvec3 Motion::chordVelocity(std::size_t from, std::size_t to) const noexcept {
    return (keyframes_[to].pose.positionMetres - keyframes_[from].pose.positionMetres) /
           (keyframes_[to].timeSeconds - keyframes_[from].timeSeconds);
}

glm::dvec3 Motion::velocityAtKeyframe(std::size_t index) const noexcept {
    const std::size_t last = keyframes_.size() - 1;
    if (index > 0 && index < last) {
        return chordVelocity(index - 1, index + 1);
    }
    if (closed_ && last > 1) {
        const double seconds = keyframes_[1].timeSeconds - keyframes_[0].timeSeconds + keyframes_[last].timeSeconds -
                               keyframes_[last - 1].timeSeconds;
        return (keyframes_[1].pose.positionMetres - keyframes_[last - 1].pose.positionMetres) / seconds;
    }
    return index == 0 ? chordVelocity(0, 1) : chordVelocity(last - 1, last);
}

Pose Motion::poseAt(double timeSeconds) const noexcept {
    const double first = keyframes_.front().timeSeconds;
    const double last = keyframes_.back().timeSeconds;
    double time = isUsable(timeSeconds) ? timeSeconds : first;
    if (loop_) {
        const double period = last - first;
        time = first + (time - first) - period * std::floor((time - first) / period);
    }
    if (time <= first) {
        return keyframes_.front().pose;
    }
    if (time >= last) {
        return keyframes_.back().pose;
    }
    const auto after =
        std::upper_bound(keyframes_.begin(), keyframes_.end(), time,
                         [](double wanted, const Keyframe& frame) { return wanted < frame.timeSeconds; });
    const auto right = static_cast<std::size_t>(after - keyframes_.begin());
    const Keyframe& a = keyframes_[right - 1];
    const Keyframe& b = keyframes_[right];
    const double span = b.timeSeconds - a.timeSeconds;
    const double u = (time - a.timeSeconds) / span;
    const double toB = u * u * (3.0 - 2.0 * u);
    const double leaving = span * u * (1.0 - u) * (1.0 - u);
    const double arriving = span * u * u * (u - 1.0);
    return {a.pose.positionMetres + toB * (b.pose.positionMetres - a.pose.positionMetres) +
                leaving * velocityAtKeyframe(right - 1) + arriving * velocityAtKeyframe(right),
            unitRotation(glm::slerp(a.pose.rotation, b.pose.rotation, u))};
}

Bounds Motion::bounds() const noexcept {
    Bounds bounds;
    for (std::size_t right = 1; right < keyframes_.size(); ++right) {
        const Keyframe& a = keyframes_[right - 1];
        const Keyframe& b = keyframes_[right];
        const double third = (b.timeSeconds - a.timeSeconds) / 3.0;
        // The cubic lies within the convex hull of its four Bezier points.
        bounds.include(a.pose.positionMetres);
        bounds.include(a.pose.positionMetres + third * velocityAtKeyframe(right - 1));
        bounds.include(b.pose.positionMetres - third * velocityAtKeyframe(right));
        bounds.include(b.pose.positionMetres);
    }
    return bounds;
}

}  // namespace haptoflow::headless
