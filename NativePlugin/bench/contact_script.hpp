#pragma once

#include "bench/bench_plan.hpp"
#include "bench/subjects.hpp"

#include <cstdint>
#include <random>
#include <vector>

namespace haptoflow::bench {

/// A contact state and when to publish it, in seconds from the script's start.
struct TimedState {
    double seconds = 0.0;
    engine::ContactState state;
};

/// When a state of a script was published, and the voice's lead as it stood then.
struct Published {
    double seconds = 0.0;
    std::uint32_t leadSamples = 0;
};

/// Where in a script a touch begins and where it is lifted.
struct Touch {
    std::size_t down = 0;
    std::size_t lift = 0;
};

struct TouchScript {
    std::vector<TimedState> states;
    std::vector<Touch> touches;
};

/// Where in a script the label steps up to the next place.
struct LabelStep {
    std::size_t index = 0;
    std::size_t place = 0;
};

struct StepScript {
    std::vector<TimedState> states;
    std::vector<LabelStep> steps;
};

/// Touches of random length with random pauses, at any phase of the device's blocks; states at the update rate within
/// and between them. Each is long enough to sound, each pause long enough to fall silent.
[[nodiscard]] TouchScript touchScript(const Hand& hand, const DeviceShape& shape, std::size_t touches,
                                      std::uint32_t firstTouch, std::mt19937_64& random);

/// Strokes over all labels of the hand, place after place, until there were at least `steps` steps. A label is held
/// longer than the device's period.
[[nodiscard]] StepScript stepScript(const Hand& hand, const DeviceShape& shape, std::size_t steps,
                                    std::uint32_t firstTouch, std::mt19937_64& random);

/// Publishes the states at their times, on this thread; says when it did.
[[nodiscard]] std::vector<Published> playScript(engine::LiveEngine& engine, engine::LiveVoice& voice,
                                                const std::vector<TimedState>& states);

}  // namespace haptoflow::bench
