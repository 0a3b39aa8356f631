#include "headless/tip_history.hpp"

#include <algorithm>
#include <glm/geometric.hpp>

namespace haptoflow::headless {
namespace {

// A tracker that measured so often without repeating itself is trusted not to.
constexpr std::size_t trustedMeasurements = 32;

}  // namespace

TipHistory::TipHistory(const VelocitySettings& settings) : settings_(settings) {
    frames_.reserve(capacity);
}

void TipHistory::clear() noexcept {
    frames_.clear();
    resting_ = false;
}

TipStep TipHistory::start(TipStep step, double timeSeconds, const glm::dvec3& positionMetres) {
    clear();
    noise_.restart();
    noise_.add(timeSeconds, positionMetres);
    movedSeconds_ = timeSeconds;
    frames_.push_back({timeSeconds, positionMetres, true});
    latestSeconds_ = timeSeconds;
    measuredSeconds_ = timeSeconds;
    measuredMetres_ = positionMetres;
    return step;
}

TipStep TipHistory::add(double timeSeconds, const glm::dvec3& positionMetres) {
    if (frames_.empty()) {
        return start(TipStep::started, timeSeconds, positionMetres);
    }
    if (timeSeconds < latestSeconds_) {
        return start(TipStep::clockRestarted, timeSeconds, positionMetres);
    }
    const double moved = glm::distance(positionMetres, measuredMetres_);
    const double sinceMeasured = timeSeconds - measuredSeconds_;
    if (timeSeconds - latestSeconds_ > settings_.maximumGapSeconds) {
        return start(TipStep::resumed, timeSeconds, positionMetres);
    }
    if (moved > settings_.maximumMoveMetres(sinceMeasured)) {
        return start(TipStep::teleported, timeSeconds, positionMetres);
    }
    latestSeconds_ = timeSeconds;
    const double frameSeconds = timeSeconds - frames_.back().timeSeconds;
    if (frameSeconds < settings_.minimumStepSeconds) {
        return TipStep::continued;
    }
    const bool hasMoved = moved > settings_.minimumMoveMetres;
    if (hasMoved) {
        measure(timeSeconds, positionMetres, frameSeconds);
    } else if (sinceMeasured >= stopSeconds()) {
        confirmStop(timeSeconds);
    }
    if (frames_.size() == capacity) {
        frames_.erase(frames_.begin());
    }
    frames_.push_back({timeSeconds, positionMetres, hasMoved || resting_});
    if (frames_.back().fresh) {
        measuredSeconds_ = timeSeconds;
        measuredMetres_ = positionMetres;
    }
    return TipStep::continued;
}

/// Learns about the tracker from a position that differs from the last.
void TipHistory::measure(double timeSeconds, const glm::dvec3& positionMetres, double frameSeconds) {
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
    noise_.add(timeSeconds, positionMetres);
}

void TipHistory::confirmStop(double timeSeconds) {
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

double TipHistory::confidence() const noexcept {
    const double held = latestSeconds_ - measuredSeconds_;
    return std::clamp((stopSeconds() - held) / (stopSeconds() - holdSeconds()), 0.0, 1.0);
}

bool TipHistory::isTrusted() const noexcept {
    return measurementsInRow_ >= trustedMeasurements;
}

double TipHistory::holdSeconds() const noexcept {
    return isTrusted() ? std::min(settings_.holdSeconds, 0.5 * moveSeconds_) : settings_.holdSeconds;
}

double TipHistory::stopSeconds() const noexcept {
    return isTrusted() ? std::min(settings_.stopSeconds, 1.5 * moveSeconds_) : settings_.stopSeconds;
}

}  // namespace haptoflow::headless
