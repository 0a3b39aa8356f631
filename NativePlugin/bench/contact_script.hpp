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

}  // namespace haptoflow::bench
