#include "headless/relative_velocity.hpp"

#include "headless/growing_fit.hpp"

#include <cstddef>
#include <glm/geometric.hpp>

namespace haptoflow::headless {
namespace {

constexpr std::size_t minimumMeasurements = 2;

/// The velocities of the newest frames that `takes` accepts, back to the longest window or to a jump that no motion
/// explains.
template <typename Takes>
RelativeVelocity velocityOf(const TipPath& path, Takes&& takes) {
    const VelocitySettings& settings = path.settings();
    const auto frames = path.frames();
    GrowingFit fit;
    for (auto frame = frames.rbegin(); frame != frames.rend() && !fit.full(); ++frame) {
        if (!takes(*frame)) {
            continue;
        }
        if (fit.count() > 0) {
            const bool isWanted =
                fit.count() < minimumMeasurements || fit.newestSeconds() - frame->timeSeconds <= settings.windowSeconds;
            const double step = fit.oldestSeconds() - frame->timeSeconds;
            if (!isWanted ||
                glm::distance(frame->positionMetres, fit.oldestMetres()) > settings.maximumMoveMetres(step)) {
                break;
            }
        }
        fit.add(frame->timeSeconds, frame->positionMetres);
    }
    const glm::dvec3 mean = fit.meanVelocity(settings.approachSeconds);
    return {path.isSlow() ? mean : fit.endVelocity(path.noiseMetres()), mean};
}

glm::dvec3 limited(const glm::dvec3& velocity, double fastest) {
    const double speed = glm::length(velocity);
    return speed > fastest ? velocity * (fastest / speed) : velocity;
}

}  // namespace

RelativeVelocity relativeVelocity(const TipPath& path) {
    const double confidence = path.confidence();
    RelativeVelocity velocity = velocityOf(path, [](const TipFrame& frame) { return frame.fresh; });
    if (confidence < 1.0) {
        const RelativeVelocity held =
            velocityOf(path, [&](const TipFrame& frame) { return frame.timeSeconds >= path.measuredSeconds(); });
        velocity = {confidence * velocity.nowMps + (1.0 - confidence) * held.nowMps,
                    confidence * velocity.approachMps + (1.0 - confidence) * held.approachMps};
    }
    const double fastest = path.settings().maximumSpeedMps;
    return {limited(velocity.nowMps, fastest), limited(velocity.approachMps, fastest)};
}

}  // namespace haptoflow::headless
