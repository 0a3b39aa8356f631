#pragma once

#include "bench/bench_plan.hpp"
#include "bench/real_time_device.hpp"
#include "bench/subjects.hpp"
#include "inference/segment_generator.hpp"
#include "inference/skeleton_generator.hpp"
#include "model/model_file.hpp"
#include "skeleton/skeleton_tensors.hpp"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <random>
#include <span>
#include <vector>

namespace haptoflow::bench {

/// Levels of the two labels of a marking skeleton. From the quiet one to the loud one, the first sample tells the
/// change.
inline constexpr float quietMps2 = 0.001F;
inline constexpr float loudMps2 = 10.0F;

/// A skeleton that sounds as white noise, softly for one label of the model and loudly for another, so that a recording
/// shows when the callback first plays the other label. Throws MeasurementError if the labels have equal embeddings.
[[nodiscard]] skeleton::NativeParts markingParts(const model::ModelFile& model, std::uint32_t quiet,
                                                 std::uint32_t loud);

/// Runs another generator, so that it takes as long, and returns the marking skeleton's segments in place of its own.
class MarkingGenerator final : public inference::SegmentGenerator {
public:
    MarkingGenerator(std::unique_ptr<inference::SegmentGenerator> behind, const skeleton::NativeParts& marking)
        : behind_(std::move(behind)), marking_(marking, 1) {}

    void generate(std::span<const inference::SegmentRequest> requests, std::span<float> segments) override {
        behind_->generate(requests, segments);
        marking_.generate(requests, segments);
    }
    void levels(std::span<const inference::SegmentRequest> requests, std::span<float> levelsMps2) override {
        marking_.levels(requests, levelsMps2);
    }

private:
    std::unique_ptr<inference::SegmentGenerator> behind_;
    inference::SkeletonGenerator marking_;
};

/// A contact state and the time to publish it, in seconds from the script's start.
struct TimedState {
    double seconds = 0.0;
    engine::ContactState state;
};

/// The states of a script at which a touch begins and ends.
struct Touch {
    std::size_t down = 0;
    std::size_t lift = 0;
};

struct TouchScript {
    std::vector<TimedState> states;
    std::vector<Touch> touches;
};

/// `steps`: the states at which the label changes from the hand's first to its second.
struct StepScript {
    std::vector<TimedState> states;
    std::vector<std::size_t> steps;
};

/// Touches of random length with random pauses, at any phase of the device's blocks, with states at the update rate
/// during and between them. Each touch is long enough to sound, and each pause long enough for silence.
[[nodiscard]] TouchScript touchScript(const Hand& hand, const DeviceShape& shape, std::size_t touches,
                                      std::uint32_t firstTouch, std::mt19937_64& random);

/// Strokes that alternate between the hand's first two labels. Returns at least `steps` changes from the first to the
/// second. Each label lasts longer than the device's period, so that every change is heard before the next.
[[nodiscard]] StepScript stepScript(const Hand& hand, const DeviceShape& shape, std::size_t steps,
                                    std::uint32_t firstTouch, std::mt19937_64& random);

/// Publishes each state at its time, on this thread. Returns the times of the clock, in seconds, at which it did.
[[nodiscard]] std::vector<double> playScript(engine::LiveEngine& engine, engine::LiveVoice& voice,
                                             const std::vector<TimedState>& states);

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
