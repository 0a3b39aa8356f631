#include "headless/tip_path.hpp"

#include <algorithm>
#include <cmath>
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

namespace {

// A cubic of so many deviations of noise ends the window, of one more for each of these speeds by which noise alone
// moves the velocity: a false alarm costs as much.
constexpr double cubicDeviations = 3.0;
constexpr double costMps = 0.01;
// So many variances of noise are left out of the square of the curvature.
constexpr double curvatureVariances = 4.0;
// Windows grow by this share, so that many places are fitted only a few times.
constexpr std::size_t growth = 8;

}  // namespace

void GrowingFit::add(double timeSeconds, const glm::dvec3& placeMetres) noexcept {
    entries_[count_++] = {timeSeconds, placeMetres};
}

glm::dvec3 GrowingFit::endVelocity(double noiseMetres) const noexcept {
    glm::dvec3 velocity(0.0);
    for (std::size_t size = 2; size <= count_; size += std::max<std::size_t>(1, size / growth)) {
        const Fit fit = fitNewest(size, noiseMetres);
        if (!fit.agrees) {
            break;
        }
        velocity = fit.endVelocityMps;
    }
    return velocity;
}

/// The difference between the means of the newer and the older half, divided by that of their times (Wald 1940).
glm::dvec3 GrowingFit::meanVelocity(double seconds) const noexcept {
    std::size_t size = std::min<std::size_t>(count_, 3);
    while (size < count_ && entries_[0].timeSeconds - entries_[size].timeSeconds <= seconds) {
        ++size;
    }
    double duration = 0.0;
    glm::dvec3 distance(0.0);
    for (std::size_t newer = 0; newer < size / 2; ++newer) {
        const TimedPlace& older = entries_[size - 1 - newer];
        duration += entries_[newer].timeSeconds - older.timeSeconds;
        distance += entries_[newer].placeMetres - older.placeMetres;
    }
    return duration > 0.0 ? distance / duration : glm::dvec3(0.0);
}

/// Fits with polynomials that are orthogonal over the times: t - mean, and two more by Gram and Schmidt. Times and
/// places count from the newest, so that nothing is lost far from the origin.
GrowingFit::Fit GrowingFit::fitNewest(std::size_t size, double noiseMetres) const noexcept {
    const auto number = static_cast<double>(size);
    double meanSeconds = 0.0;
    for (std::size_t index = 0; index < size; ++index) {
        meanSeconds += entries_[index].timeSeconds - entries_[0].timeSeconds;
    }
    meanSeconds /= number;

    double second = 0.0;
    double third = 0.0;
    double fourth = 0.0;
    glm::dvec3 slope(0.0);
    for (std::size_t index = 0; index < size; ++index) {
        const double linear = entries_[index].timeSeconds - entries_[0].timeSeconds - meanSeconds;
        const double square = linear * linear;
        second += square;
        third += square * linear;
        fourth += square * square;
        slope += linear * (entries_[index].placeMetres - entries_[0].placeMetres);
    }
    slope /= second;
    if (size == 2) {
        return {slope, true};
    }

    const double skew = third / second;
    const double spread = second / number;
    double norm = 0.0;
    double cross = 0.0;
    glm::dvec3 curvature(0.0);
    for (std::size_t index = 0; index < size; ++index) {
        const double linear = entries_[index].timeSeconds - entries_[0].timeSeconds - meanSeconds;
        const double quadratic = (linear - skew) * linear - spread;
        norm += quadratic * quadratic;
        cross += quadratic * linear * linear * linear;
        curvature += quadratic * (entries_[index].placeMetres - entries_[0].placeMetres);
    }
    curvature /= norm;

    const double variance = noiseMetres * noiseMetres;
    const double explained = glm::dot(curvature, curvature) * norm;
    const double surplus = explained - curvatureVariances * variance;
    const double share = surplus > 0.0 ? surplus / explained : 0.0;
    const double lever = -2.0 * meanSeconds - skew;
    const glm::dvec3 velocity = slope + share * lever * curvature;
    if (size == 3) {
        return {velocity, true};
    }

    const double tilt = cross / norm;
    const double lean = fourth / second;
    double cubicNorm = 0.0;
    glm::dvec3 cubic(0.0);
    for (std::size_t index = 0; index < size; ++index) {
        const double linear = entries_[index].timeSeconds - entries_[0].timeSeconds - meanSeconds;
        const double quadratic = (linear - skew) * linear - spread;
        const double value = linear * linear * linear - tilt * quadratic - lean * linear - third / number;
        cubicNorm += value * value;
        cubic += value * (entries_[index].placeMetres - entries_[0].placeMetres);
    }
    const double velocityVariance = variance * (1.0 / second + lever * lever / norm);
    const double deviations = cubicDeviations + std::sqrt(velocityVariance) / costMps;
    return {velocity, glm::dot(cubic, cubic) <= deviations * deviations * variance * cubicNorm};
}

namespace {

constexpr double leastMetres = 5e-6;
constexpr double mostMetres = 500e-6;
constexpr double quantile = 0.35;
// That quantile of the length of three standard normal numbers.
constexpr double quantileLength = 1.2812;
constexpr double step = 0.1;

}  // namespace

void TrackerNoise::add(double timeSeconds, const glm::dvec3& placeMetres) noexcept {
    std::rotate(newest_.begin(), newest_.end() - 1, newest_.end());
    newest_[0] = {timeSeconds, placeMetres};
    count_ = std::min(count_ + 1, newest_.size());
    if (count_ < newest_.size()) {
        return;
    }
    const double seconds = newest_[0].timeSeconds - newest_[3].timeSeconds;
    glm::dvec3 difference(0.0);
    double norm = 0.0;
    for (std::size_t index = 0; index < newest_.size(); ++index) {
        // Divided by the time from first to last, because the cubes of seconds would make the weights huge.
        double weight = 1.0;
        for (std::size_t other = 0; other < newest_.size(); ++other) {
            if (other != index) {
                weight *= seconds / (newest_[index].timeSeconds - newest_[other].timeSeconds);
            }
        }
        norm += weight * weight;
        difference += weight * (newest_[index].placeMetres - newest_[0].placeMetres);
    }
    const bool isAbove = glm::length(difference) > quantileLength * metres_ * std::sqrt(norm);
    metres_ = std::clamp(metres_ * (isAbove ? 1.0 + step * quantile : 1.0 - step * (1.0 - quantile)), leastMetres,
                         mostMetres);
}

}  // namespace haptoflow::headless
