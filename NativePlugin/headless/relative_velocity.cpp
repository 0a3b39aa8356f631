#include "headless/relative_velocity.hpp"

#include <array>
#include <cstddef>
#include <glm/geometric.hpp>

namespace haptoflow::headless {
namespace {

constexpr int minimumMeasurements = 3;
// Three measurements may be this many windows old; two may be as old as the history.
constexpr double sparseWindows = 3.0;

/// Positions at times, newest first, and the slope of the straight line through them: the difference between the means
/// of the newer and the older half, divided by that of their times (Wald 1940). Least squares would be right for exact
/// times, but a tracker with its own clock has errors in the times, which bias a least-squares slope towards zero: by 4
/// % for 60 Hz sampled at 90 Hz.
class RecentPlaces {
public:
    void add(double time, const glm::dvec3& place) { entries_[count_++] = {time, place}; }
    [[nodiscard]] int count() const { return static_cast<int>(count_); }
    [[nodiscard]] bool full() const { return count_ == entries_.size(); }

    [[nodiscard]] glm::dvec3 slope() const {
        // For an odd number the middle one belongs to neither half.
        const std::size_t half = count_ / 2;
        double seconds = 0.0;
        glm::dvec3 distance(0.0);
        for (std::size_t index = 0; index < half; ++index) {
            const Entry& older = entries_[count_ - 1 - index];
            seconds += entries_[index].time - older.time;
            distance += entries_[index].place - older.place;
        }
        return seconds > 0.0 ? distance / seconds : glm::dvec3(0.0);
    }

    [[nodiscard]] double newestTime() const { return entries_[0].time; }
    [[nodiscard]] double oldestTime() const { return entries_[count_ - 1].time; }
    [[nodiscard]] const glm::dvec3& oldestPlace() const { return entries_[count_ - 1].place; }

private:
    struct Entry {
        double time = 0.0;
        glm::dvec3 place{0.0};
    };
    std::array<Entry, TipHistory::capacity> entries_{};
    std::size_t count_ = 0;
};

/// The slope of a line through `placeOf` each of the newest frames that `takes` accepts, back to the end of the window
/// or to a jump that no motion explains.
template <typename Takes, typename PlaceOf>
glm::dvec3 recentSlope(const TipHistory& history, Takes&& takes, PlaceOf&& placeOf) {
    const VelocitySettings& settings = history.settings();
    const auto frames = history.frames();
    RecentPlaces recent;
    for (auto frame = frames.rbegin(); frame != frames.rend() && !recent.full(); ++frame) {
        if (!takes(*frame)) {
            continue;
        }
        const glm::dvec3 place = placeOf(*frame);
        if (recent.count() > 0) {
            const double age = recent.newestTime() - frame->timeSeconds;
            const bool wanted = age <= settings.windowSeconds || recent.count() < 2 ||
                                (recent.count() < minimumMeasurements && age <= sparseWindows * settings.windowSeconds);
            const double step = recent.oldestTime() - frame->timeSeconds;
            if (!wanted || glm::distance(place, recent.oldestPlace()) > settings.maximumMoveMetres(step)) {
                break;
            }
        }
        recent.add(frame->timeSeconds, place);
    }
    return recent.slope();
}

}  // namespace

glm::dvec3 relativeVelocity(const TipHistory& history, const SceneSurface& surface, const glm::dvec3& localPoint) {
    // For a surface at rest its coordinates are left out of the sums, where they would only add rounding errors.
    const auto material = [&](const TipFrame& frame) {
        return surface.motion ? surface.poseAt(frame.timeSeconds).pointToWorld(localPoint) : glm::dvec3(0.0);
    };
    const double confidence = history.confidence();
    glm::dvec3 velocity =
        confidence * recentSlope(
                         history, [](const TipFrame& frame) { return frame.fresh; },
                         [&](const TipFrame& frame) { return frame.positionMetres - material(frame); });
    if (surface.motion && confidence < 1.0) {
        velocity -= (1.0 - confidence) * recentSlope(
                                             history, [](const TipFrame&) { return true; }, material);
    }
    const double fastest = history.settings().maximumSpeedMps;
    const double speed = glm::length(velocity);
    return speed > fastest ? velocity * (fastest / speed) : velocity;
}

}  // namespace haptoflow::headless
