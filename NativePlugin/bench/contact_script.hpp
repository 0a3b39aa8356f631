#pragma once

#include "bench/bench_plan.hpp"
#include "bench/subjects.hpp"

#include <cstdint>
#include <random>
#include <vector>

namespace haptoflow::bench {

/// A contact state and the time to publish it, in seconds from the script's start.
struct TimedState {
    double seconds = 0.0;
    engine::ContactState state;
};

/// The time at which a state of a script was published, and the voice's lead at that time.
struct Published {
    double seconds = 0.0;
    std::uint32_t leadSamples = 0;
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

/// The state of a script at which the label changes to the next one.
struct LabelStep {
    std::size_t index = 0;
    std::size_t place = 0;
};

struct StepScript {
    std::vector<TimedState> states;
    std::vector<LabelStep> steps;
};

/// Touches of random length with random pauses, at any phase of the device's blocks, with states at the update rate
/// during and between them. Each touch is long enough to sound, and each pause long enough for silence.
[[nodiscard]] TouchScript touchScript(const Hand& hand, const DeviceShape& shape, std::size_t touches,
                                      std::uint32_t firstTouch, std::mt19937_64& random);

/// Strokes over all labels of the hand in turn, until there are at least `steps` changes of label. Each label lasts
/// longer than the device's period.
[[nodiscard]] StepScript stepScript(const Hand& hand, const DeviceShape& shape, std::size_t steps,
                                    std::uint32_t firstTouch, std::mt19937_64& random);

/// Publishes the states at their times on this thread, and returns the actual times.
[[nodiscard]] std::vector<Published> playScript(engine::LiveEngine& engine, engine::LiveVoice& voice,
                                                const std::vector<TimedState>& states);

}  // namespace haptoflow::bench
