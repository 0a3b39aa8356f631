#pragma once

#include "bench/bench_plan.hpp"
#include "bench/subjects.hpp"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace haptoflow::bench {

/// "inference_ms": the time to generate one segment with each tier of the model on one thread, once without pauses and
/// once every 1/72 s. With the paper's model also "paper_architecture_ms" and "speedup_vs_paper_architecture" from the
/// same run. All tiers run in blocks in random order, so that a slow second of the machine affects all of them alike.
[[nodiscard]] nlohmann::ordered_json measureInference(const Subjects& subjects, const BenchPlan& plan,
                                                      const Advance& advance);

/// "voices": the segments of several voices in one batch, compared with as many batches of one, by the tier "standard".
/// "sketch_voices": the same by the tier of kind `skeleton`, if the model has one.
[[nodiscard]] nlohmann::ordered_json measureVoices(const Subjects& subjects, const BenchPlan& plan,
                                                   const Advance& advance);

/// "callback_us": the audio callback of 1, 2 and 8 sliding voices in blocks of 256 frames, compared with that of as
/// many voices that write silence. Hot: on one thread without waiting, with a round of inference whenever an update is
/// due. Paced: in real time, with the engine's worker and a device's thread.
[[nodiscard]] nlohmann::ordered_json measureCallback(const Subjects& subjects, const BenchPlan& plan,
                                                     const Advance& advance);

/// "effects": the time that each effect adds to a block of the callback where a contact state requests it, and a check
/// that it does not run elsewhere. The tip slides, lands five times a second and crosses between labels ten times a
/// second.
[[nodiscard]] nlohmann::ordered_json measureEffects(const Subjects& subjects, const BenchPlan& plan,
                                                    const Advance& advance);

/// "idle": the inferences and the load of a core while nothing touches, in real time: states at the update rate, blocks
/// from a device. Compared with the same two threads without voice and engine.
[[nodiscard]] nlohmann::ordered_json measureIdle(const Subjects& subjects, const BenchPlan& plan,
                                                 const Advance& advance);

/// Percentiles of repeated measurements. A mean would hide the slow ones, which are the perceptible ones.
struct Distribution {
    std::size_t count = 0;
    double p50 = 0.0;
    double p99 = 0.0;
    double worst = 0.0;
};

/// Scales of `toJson` for values in seconds.
inline constexpr double milliseconds = 1e3;
inline constexpr double microseconds = 1e6;

/// By nearest rank: p50 and p99 are measured values, and below 100 values p99 is the worst one.
/// Throws std::invalid_argument if there are no values.
[[nodiscard]] Distribution distributionOf(std::vector<double> values);

/// The number rounded to six significant digits; further digits of a time are noise.
[[nodiscard]] double rounded(double value);

/// {"count", "p50", "p99", "worst"}, each multiplied by `scale` and rounded.
[[nodiscard]] nlohmann::ordered_json toJson(const Distribution& distribution, double scale = 1.0);

/// numerator / denominator, both rounded as they are printed; null if the denominator is 0.
[[nodiscard]] nlohmann::ordered_json ratioOf(double numerator, double denominator);

/// Processor, cores, system and build, which every reported time depends on. Nothing in it identifies the machine.
[[nodiscard]] nlohmann::ordered_json machineWords(const std::string& onnxRuntimeVersion);

/// The system's load average over the last minute, this process included; null where the system does not report one.
[[nodiscard]] nlohmann::ordered_json loadAverage();

/// The date in UTC as YYYY-MM-DD.
[[nodiscard]] std::string today();

/// Processor time that all threads of this process have used, in seconds.
[[nodiscard]] double processCpuSeconds();

/// Memory of this process that is in RAM now, in MiB; 0 where the system does not report it.
[[nodiscard]] double residentMebibytes();

}  // namespace haptoflow::bench
