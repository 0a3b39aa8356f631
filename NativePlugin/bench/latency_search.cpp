#include "bench/latency_bench.hpp"
#include "bench/watched_generators.hpp"

namespace haptoflow::bench {
namespace {

constexpr float minus60Db = 1e-3F;
constexpr double releaseSeconds = 0.005;
constexpr double takingOverSeconds = 0.001;

/// The time at which the next touch begins, or the end of the script after the last touch.
double nextDown(const std::vector<Published>& published, const TouchScript& script, std::size_t touch) {
    return touch + 1 < script.touches.size() ? published[script.touches[touch + 1].down].seconds
                                             : published.back().seconds;
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

void findOnsets(const Recording& recording, const std::vector<Published>& published, const TouchScript& script,
                const DeviceShape& shape, Latencies& onsets) {
    for (std::size_t touch = 0; touch < script.touches.size(); ++touch) {
        const double down = published[script.touches[touch].down].seconds;
        const double end = nextDown(published, script, touch);
        const float peak = recording.peak(down, end);
        note(peak > 0.0F ? recording.first(peak * minus60Db, down, end) : std::nullopt, down, shape.periodSeconds(),
             onsets);
    }
}

void findStops(const Recording& recording, const std::vector<Published>& published, const TouchScript& script,
               const DeviceShape& shape, Latencies& stops) {
    for (std::size_t touch = 0; touch < script.touches.size(); ++touch) {
        const double down = published[script.touches[touch].down].seconds;
        const double lift = published[script.touches[touch].lift].seconds;
        const double end = nextDown(published, script, touch);
        const float peak = recording.peak(down, end);
        auto last = peak > 0.0F ? recording.last(peak * minus60Db, lift, end) : std::nullopt;
        if (last) {
            *last += 1.0 / recording.rateHz;
        }
        note(last, lift, shape.periodSeconds() + releaseSeconds, stops);
    }
}

void findSteps(const Recording& recording, const std::vector<Published>& published, const StepScript& script,
               const DeviceShape& shape, float fullScaleMps2, Latencies& steps) {
    for (const LabelStep& step : script.steps) {
        const double stepped = published[step.index].seconds;
        const float before = MarkingGenerator::markMps2(step.place - 1);
        const float after = MarkingGenerator::markMps2(step.place);
        const float midway = 0.5F * (before + after) / fullScaleMps2;
        // Longer than any lead and any period of a device: after this time the change of label was lost.
        constexpr double maximumSeconds = 0.3;
        const double lead = published[step.index + 1].leadSamples / inference::waveformRateHz;
        note(recording.first(midway, stepped, stepped + maximumSeconds), stepped,
             lead + shape.periodSeconds() + takingOverSeconds, steps);
    }
}

}  // namespace haptoflow::bench
