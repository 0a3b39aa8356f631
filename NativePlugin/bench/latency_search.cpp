#include "bench/latency_bench.hpp"
#include "bench/marking.hpp"

namespace haptoflow::bench {
namespace {

constexpr float minus60Db = 1e-3F;
constexpr double releaseSeconds = 0.005;
constexpr double soundingSeconds = 0.0015;

/// The time at which the next touch begins, or the end of the script after the last touch.
double nextDown(const std::vector<double>& published, const TouchScript& script, std::size_t touch) {
    return touch + 1 < script.touches.size() ? published[script.touches[touch + 1].down] : published.back();
}

void note(std::optional<double> sounded, double published, double goalSeconds, Latencies& latencies) {
    if (!sounded) {
        ++latencies.missed;
        return;
    }
    latencies.seconds.push_back(*sounded - published);
    latencies.goalSeconds.push_back(goalSeconds);
}

}  // namespace

void findOnsets(const Recording& recording, const std::vector<double>& published, const TouchScript& script,
                const DeviceShape& shape, Latencies& onsets) {
    for (std::size_t touch = 0; touch < script.touches.size(); ++touch) {
        const double down = published[script.touches[touch].down];
        const double end = nextDown(published, script, touch);
        const float peak = recording.peak(down, end);
        note(peak > 0.0F ? recording.first(peak * minus60Db, down, end) : std::nullopt, down, shape.periodSeconds(),
             onsets);
    }
}

void findStops(const Recording& recording, const std::vector<double>& published, const TouchScript& script,
               const DeviceShape& shape, Latencies& stops) {
    for (std::size_t touch = 0; touch < script.touches.size(); ++touch) {
        const double down = published[script.touches[touch].down];
        const double lift = published[script.touches[touch].lift];
        const double end = nextDown(published, script, touch);
        const float peak = recording.peak(down, end);
        auto last = peak > 0.0F ? recording.last(peak * minus60Db, lift, end) : std::nullopt;
        if (last) {
            *last += 1.0 / recording.rateHz;
        }
        note(last, lift, shape.periodSeconds() + releaseSeconds, stops);
    }
}

void findSteps(const Recording& recording, const std::vector<double>& published, const StepScript& script,
               const DeviceShape& shape, double filterSeconds, float fullScaleMps2, Latencies& steps) {
    // A tenth of the loud label's RMS. Nearly every sample of the loud label exceeds it, no sample of the quiet one
    // does.
    constexpr float recognised = 0.1F * loudMps2;
    // Longer than any period of a device: after this time the change of label was lost.
    constexpr double maximumSeconds = 0.3;
    for (const std::size_t step : script.steps) {
        const double stepped = published[step];
        note(recording.first(recognised / fullScaleMps2, stepped, stepped + maximumSeconds), stepped,
             shape.periodSeconds() + filterSeconds + soundingSeconds, steps);
    }
}

}  // namespace haptoflow::bench
