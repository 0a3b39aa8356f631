#include "headless/scenes/time_unit.hpp"

#include "recordings/recording.hpp"
#include "recordings/track.hpp"

#include <array>
#include <cstddef>
#include <numeric>
#include <utility>

namespace haptoflow::cli {
namespace {

/// Trackers, scenes and hands have shorter steps, and waypoints fewer of them or more speed.
constexpr double longStepSeconds = 0.5;
constexpr double longestWaypointSeconds = 300.0;
constexpr std::size_t fewSteps = 3;
constexpr std::size_t manySteps = 30;
constexpr double longestTrackedSeconds = 2.0;
/// No hand is slower for long, and none is faster.
constexpr double slowestMps = 0.002;
constexpr double fastestMps = 10.0;
constexpr double longestReadableSeconds = 0.5;

}  // namespace

std::string unitOfTimes(std::span<const double> steps, double metres) {
    if (steps.empty()) {
        return {};
    }
    constexpr std::array<std::pair<const char*, double>, 3> units{
        {{"milliseconds", 1e3}, {"microseconds", 1e6}, {"nanoseconds", 1e9}}};
    const double step = recordings::medianOfSteps({steps.begin(), steps.end()});
    const double seconds = std::accumulate(steps.begin(), steps.end(), 0.0);
    const double speedMps = seconds > 0.0 ? metres / seconds : 0.0;
    for (const auto& [name, perSecond] : units) {
        const bool isPlausible =
            speedMps < slowestMps && speedMps * perSecond >= slowestMps && speedMps * perSecond <= fastestMps;
        const bool isLong = steps.size() >= fewSteps ? step >= longStepSeconds : step >= longestWaypointSeconds;
        const bool isTracked =
            steps.size() >= manySteps && step >= longestTrackedSeconds && step / perSecond <= longestReadableSeconds;
        if ((isLong && isPlausible) || isTracked) {
            return "rises by " + recordings::plainNumber(step) + " s a row in the median, with a speed of " +
                   recordings::plainNumber(1e3 * speedMps) + " mm/s; expected seconds: are these " + name +
                   "? Divide them by " + recordings::plainNumber(perSecond);
        }
    }
    return {};
}

}  // namespace haptoflow::cli
