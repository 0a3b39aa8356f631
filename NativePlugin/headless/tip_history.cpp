#include "headless/tip_history.hpp"

#include <algorithm>
#include <glm/geometric.hpp>

namespace haptoflow::headless {

TipHistory::TipHistory(const VelocitySettings& settings) : settings_(settings) {
    frames_.reserve(capacity);
}

void TipHistory::clear() noexcept {
    frames_.clear();
    resting_ = false;
}

TipStep TipHistory::start(TipStep step, double timeSeconds, const glm::dvec3& positionMetres) {
    clear();
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
    if (timeSeconds - frames_.back().timeSeconds < settings_.minimumStepSeconds) {
        return TipStep::continued;
    }
    if (moved > settings_.minimumMoveMetres) {
        resting_ = false;
    } else if (sinceMeasured >= settings_.stopSeconds) {
        confirmStop(timeSeconds);
    }
    const bool fresh = resting_ || moved > settings_.minimumMoveMetres;
    if (frames_.size() == capacity) {
        frames_.erase(frames_.begin());
    }
    frames_.push_back({timeSeconds, positionMetres, fresh});
    if (fresh) {
        measuredSeconds_ = timeSeconds;
        measuredMetres_ = positionMetres;
    }
    return TipStep::continued;
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
    const double fading = settings_.stopSeconds - settings_.holdSeconds;
    return std::clamp((settings_.stopSeconds - held) / fading, 0.0, 1.0);
}

}  // namespace haptoflow::headless
