#include "headless/tip_path.hpp"

#include "headless/growing_fit.hpp"

#include <algorithm>
#include <cstddef>
#include <glm/geometric.hpp>
#include <limits>

namespace haptoflow::headless {

TipHistory::TipHistory(const VelocitySettings& settings) : settings_(settings) {
    frames_.reserve(capacity);
}

TipStep TipHistory::add(double timeSeconds, const glm::dvec3& worldMetres) {
    TipStep step = frames_.empty() ? TipStep::started : TipStep::continued;
    if (!frames_.empty() && timeSeconds < latestSeconds_) {
        step = TipStep::clockRestarted;
    } else if (!frames_.empty() && timeSeconds - latestSeconds_ > settings_.maximumGapSeconds) {
        step = TipStep::resumed;
    }
    if (step != TipStep::continued) {
        frames_.clear();
    }
    latestSeconds_ = timeSeconds;
    if (!frames_.empty() && timeSeconds - frames_.back().timeSeconds < settings_.minimumStepSeconds) {
        return step;
    }
    if (frames_.size() == capacity) {
        frames_.erase(frames_.begin());
    }
    frames_.push_back({timeSeconds, worldMetres});
    return step;
}

namespace {

// A tracker that measured so often without repeating itself is trusted not to.
constexpr std::size_t trustedMeasurements = 32;
// The first repetition of a position is no stop at any frame rate: a hitch shows one position for long, once.
constexpr std::size_t stopRepeats = 2;
// So many measurements tell how fast the tip was before a step.
constexpr std::size_t measurementsBefore = 4;
constexpr double unknownSpeed = std::numeric_limits<double>::infinity();

}  // namespace

TipPath::TipPath(const VelocitySettings& settings) : settings_(settings) {
    frames_.reserve(capacity);
}

void TipPath::clear() noexcept {
    frames_.clear();
    resting_ = false;
    hasRepeated_ = false;
    measurementsInRow_ = 0;
    repeatsInRow_ = 0;
}

TipStep TipPath::start(TipStep step, double timeSeconds, const glm::dvec3& surfaceMetres, const glm::dvec3& worldMetres,
                       double speedMps) {
    frames_.clear();
    resting_ = false;
    repeatsInRow_ = 0;
    noise_.restart();
    noise_.add(timeSeconds, surfaceMetres);
    movedSeconds_ = timeSeconds;
    frames_.push_back({timeSeconds, surfaceMetres, true, speedMps});
    latestSeconds_ = timeSeconds;
    measuredSeconds_ = timeSeconds;
    measuredMetres_ = surfaceMetres;
    measuredWorldMetres_ = worldMetres;
    return step;
}

TipStep TipPath::add(double timeSeconds, const glm::dvec3& surfaceMetres, const glm::dvec3& worldMetres) {
    if (frames_.empty()) {
        return start(TipStep::started, timeSeconds, surfaceMetres, worldMetres, unknownSpeed);
    }
    if (timeSeconds < latestSeconds_) {
        return start(TipStep::clockRestarted, timeSeconds, surfaceMetres, worldMetres, unknownSpeed);
    }
    const double moved = glm::distance(surfaceMetres, measuredMetres_);
    const double movedInWorld = glm::distance(worldMetres, measuredWorldMetres_);
    const double sinceMeasured = timeSeconds - measuredSeconds_;
    const double speed = moved / std::max(sinceMeasured, settings_.minimumJumpSeconds);
    if (timeSeconds - latestSeconds_ > settings_.maximumGapSeconds) {
        return start(TipStep::resumed, timeSeconds, surfaceMetres, worldMetres, unknownSpeed);
    }
    // Under a tip that rests in the world each frame measures the surface.
    const bool isHeld = movedInWorld <= settings_.minimumMoveMetres;
    if (isHeld ? isJump(glm::distance(surfaceMetres, frames_.back().positionMetres),
                        timeSeconds - frames_.back().timeSeconds, true)
               : isJump(moved, sinceMeasured, false)) {
        // What goes on at the speed of a jump is motion from then on.
        return start(TipStep::jumped, timeSeconds, surfaceMetres, worldMetres, speed);
    }
    latestSeconds_ = timeSeconds;
    const double frameSeconds = timeSeconds - frames_.back().timeSeconds;
    if (frameSeconds < settings_.minimumStepSeconds) {
        return TipStep::continued;
    }
    const bool hasMoved = moved > settings_.minimumMoveMetres && !isHeld;
    repeatsInRow_ = hasMoved ? 0 : repeatsInRow_ + 1;
    if (hasMoved) {
        measure(timeSeconds, surfaceMetres, frameSeconds);
    } else if (repeatsInRow_ >= stopRepeats && sinceMeasured >= stopSeconds()) {
        confirmStop(timeSeconds);
    }
    if (frames_.size() == capacity) {
        frames_.erase(frames_.begin());
    }
    frames_.push_back({timeSeconds, surfaceMetres, hasMoved || resting_, speed});
    if (frames_.back().fresh) {
        measuredSeconds_ = timeSeconds;
        measuredMetres_ = surfaceMetres;
        measuredWorldMetres_ = worldMetres;
    }
    return TipStep::continued;
}

bool TipPath::isJump(double moved, double seconds, bool isHeld) const noexcept {
    double fastestBefore = 0.0;
    std::size_t measurements = 0;
    for (auto frame = frames_.rbegin(); frame != frames_.rend() && measurements < measurementsBefore; ++frame) {
        if (frame->fresh) {
            fastestBefore = std::max(fastestBefore, frame->speedMps);
            ++measurements;
        }
    }
    if (isHeld && fastestBefore == unknownSpeed) {
        // A tip whose speed is not known yet may be fast, but not one that rests in the world.
        fastestBefore = 0.0;
    }
    return settings_.isJump(moved, seconds, fastestBefore);
}

/// Learns about the tracker from a position that differs from the last.
void TipPath::measure(double timeSeconds, const glm::dvec3& surfaceMetres, double frameSeconds) {
    moveSeconds_ = timeSeconds - movedSeconds_;
    movedSeconds_ = timeSeconds;
    resting_ = false;
    measurementsInRow_ = std::min(measurementsInRow_ + 1, trustedMeasurements);
    if (moveSeconds_ > frameSeconds) {
        noise_.restart();
        if (moveSeconds_ <= settings_.stopSeconds) {
            hasRepeated_ = true;
            measurementsInRow_ = 0;
        }
    }
    noise_.add(timeSeconds, surfaceMetres);
}

void TipPath::confirmStop(double timeSeconds) {
    if (resting_) {
        return;
    }
    resting_ = true;
    std::erase_if(frames_, [this](const TipFrame& frame) { return frame.timeSeconds < measuredSeconds_; });
    for (TipFrame& frame : frames_) {
        frame.fresh = true;
    }
    measuredSeconds_ = timeSeconds;
}

double TipPath::confidence() const noexcept {
    // A frame that was skipped has told nothing.
    const double held = frames_.empty() ? 0.0 : frames_.back().timeSeconds - measuredSeconds_;
    return std::clamp((stopSeconds() - held) / (stopSeconds() - holdSeconds()), 0.0, 1.0);
}

bool TipPath::isTrusted() const noexcept {
    return measurementsInRow_ >= trustedMeasurements;
}

double TipPath::holdSeconds() const noexcept {
    return isTrusted() ? std::min(settings_.holdSeconds, 0.5 * moveSeconds_) : settings_.holdSeconds;
}

double TipPath::stopSeconds() const noexcept {
    return isTrusted() ? std::min(settings_.stopSeconds, 1.5 * moveSeconds_) : settings_.stopSeconds;
}

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
