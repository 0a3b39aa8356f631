#pragma once

#include "bench/bench_clock.hpp"
#include "bench/bench_plan.hpp"
#include "bench/contact_script.hpp"
#include "bench/recording.hpp"
#include "bench/subjects.hpp"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <vector>

namespace haptoflow::bench {

/// Seconds from what the hand did to what the device played, and how often nothing was found that belongs to it.
struct Latencies {
    std::vector<double> seconds;
    /// Of each, the goal that held for it.
    std::vector<double> goalSeconds;
    std::size_t missed = 0;
};

/// Onset: from publishing a touch-down to the first sample within 60 dB of the touch's peak.
void findOnsets(const Recording& recording, const std::vector<Published>& published, const TouchScript& script,
                const DeviceShape& shape, Latencies& onsets);
/// Stop: from publishing a lift-off to the end of the last sample within 60 dB of the touch's peak.
void findStops(const Recording& recording, const std::vector<Published>& published, const TouchScript& script,
               const DeviceShape& shape, Latencies& stops);
/// Contact to sound: from publishing a label step to the first sample nearer to the new label's mark than to the old
/// one's. `fullScaleMps2` is +-1 of the recording. The lead of each goal is the one noted with the next state.
void findSteps(const Recording& recording, const std::vector<Published>& published, const StepScript& script,
               const DeviceShape& shape, float fullScaleMps2, Latencies& steps);

/// "onset_ms", "contact_to_sound_ms" and "stop_ms", with a row for each device. With real threads: the engine's worker,
/// a device's, and this one, which publishes. Throws MeasurementError where nothing sounds.
[[nodiscard]] nlohmann::ordered_json measureLatency(const Subjects& subjects, const BenchPlan& plan,
                                                    const Advance& advance);

}  // namespace haptoflow::bench
