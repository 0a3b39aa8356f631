#include "headless/tip_history.hpp"

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

}  // namespace haptoflow::headless
