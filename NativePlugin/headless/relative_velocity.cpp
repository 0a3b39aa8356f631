#include "headless/relative_velocity.hpp"

#include "headless/growing_fit.hpp"

#include <cstddef>
#include <glm/geometric.hpp>

namespace haptoflow::headless {
namespace {

constexpr std::size_t minimumMeasurements = 2;

/// The velocities of `placeOf` the newest frames that `takes` accepts, back to the longest window or to a jump that no
/// motion explains.
template <typename Takes, typename PlaceOf>
RelativeVelocity velocityOf(const TipHistory& history, Takes&& takes, PlaceOf&& placeOf) {
    const VelocitySettings& settings = history.settings();
    const auto frames = history.frames();
    GrowingFit fit;
    for (auto frame = frames.rbegin(); frame != frames.rend() && !fit.full(); ++frame) {
        if (!takes(*frame)) {
            continue;
        }
        const glm::dvec3 place = placeOf(*frame);
        if (fit.count() > 0) {
            const bool isWanted =
                fit.count() < minimumMeasurements || fit.newestSeconds() - frame->timeSeconds <= settings.windowSeconds;
            const double step = fit.oldestSeconds() - frame->timeSeconds;
            if (!isWanted || glm::distance(place, fit.oldestMetres()) > settings.maximumMoveMetres(step)) {
                break;
            }
        }
        fit.add(frame->timeSeconds, place);
    }
    const glm::dvec3 mean = fit.meanVelocity(settings.approachSeconds);
    return {history.isSlow() ? mean : fit.endVelocity(history.noiseMetres()), mean};
}

glm::dvec3 limited(const glm::dvec3& velocity, double fastest) {
    const double speed = glm::length(velocity);
    return speed > fastest ? velocity * (fastest / speed) : velocity;
}

}  // namespace

RelativeVelocity relativeVelocity(const TipHistory& history, const SceneSurface& surface,
                                  const glm::dvec3& localPoint) {
    // For a surface at rest its coordinates are left out of the sums, where they would only add rounding errors.
    const auto material = [&](const TipFrame& frame) {
        return surface.motion ? surface.poseAt(frame.timeSeconds).pointToWorld(localPoint) : glm::dvec3(0.0);
    };
    const double confidence = history.confidence();
    RelativeVelocity velocity = velocityOf(
        history, [](const TipFrame& frame) { return frame.fresh; },
        [&](const TipFrame& frame) { return frame.positionMetres - material(frame); });
    velocity = {confidence * velocity.nowMps, confidence * velocity.approachMps};
    if (surface.motion && confidence < 1.0) {
        const RelativeVelocity own = velocityOf(
            history, [](const TipFrame&) { return true; }, material);
        velocity.nowMps -= (1.0 - confidence) * own.nowMps;
        velocity.approachMps -= (1.0 - confidence) * own.approachMps;
    }
    const double fastest = history.settings().maximumSpeedMps;
    return {limited(velocity.nowMps, fastest), limited(velocity.approachMps, fastest)};
}

}  // namespace haptoflow::headless
