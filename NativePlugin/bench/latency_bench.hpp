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

/// Times in seconds from an action of the hand to its effect in the played signal, and the number of actions without
/// one.
struct Latencies {
    std::vector<double> seconds;
    /// The goal for each time, which depends on the device.
    std::vector<double> goalSeconds;
    std::size_t missed = 0;
};

/// Onset: from publishing a touch-down to the first sample within 60 dB of the touch's peak.
void findOnsets(const Recording& recording, const std::vector<double>& published, const TouchScript& script,
                const DeviceShape& shape, Latencies& onsets);
/// Stop: from publishing a lift-off to the end of the last sample within 60 dB of the touch's peak.
void findStops(const Recording& recording, const std::vector<double>& published, const TouchScript& script,
               const DeviceShape& shape, Latencies& stops);
/// Contact to sound: from publishing a change from the quiet to the loud label of markingParts to the first sample that
/// only the loud one has. The goal is a period, the delay of the output's filter, and 1.5 ms. `fullScaleMps2` is the
/// acceleration at +-1 of the recording.
void findSteps(const Recording& recording, const std::vector<double>& published, const StepScript& script,
               const DeviceShape& shape, double filterSeconds, float fullScaleMps2, Latencies& steps);

/// "onset_ms", "contact_to_sound_ms" and "stop_ms", with a row for each device. Uses real threads: the engine's worker,
/// a device's thread, and this one, which publishes. Throws MeasurementError if nothing sounds.
[[nodiscard]] nlohmann::ordered_json measureLatency(const Subjects& subjects, const BenchPlan& plan,
                                                    const Advance& advance);

}  // namespace haptoflow::bench
