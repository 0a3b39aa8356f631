#pragma once

#include "bench/bench_plan.hpp"
#include "bench/subjects.hpp"

#include <nlohmann/json.hpp>

#include <cstdint>

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

/// "contact": the time of one frame of a tip that slides over scenes of 10 to 10,000 surfaces at rest: boxes, spheres
/// and capsules in turn, equally far apart in all scenes.
[[nodiscard]] nlohmann::ordered_json measureContact(std::uint64_t seed, const BenchPlan& plan, const Advance& advance);

/// "idle": the inferences and the load of a core while nothing touches, in real time: states at the update rate, blocks
/// from a device. Compared with the same two threads without voice and engine.
[[nodiscard]] nlohmann::ordered_json measureIdle(const Subjects& subjects, const BenchPlan& plan,
                                                 const Advance& advance);

}  // namespace haptoflow::bench
