#include "bench/contact_script.hpp"

#include "bench/bench_clock.hpp"

#include <algorithm>
#include <cmath>

namespace haptoflow::bench {
namespace {

constexpr double updateSeconds = 1.0 / updateRateHz;
// Silence before a script begins, until its device has started.
constexpr double quietSeconds = 0.05;
constexpr std::size_t stepsOfAStroke = 6;
// A state closer to the end than this would be published twice.
constexpr double minimumSeconds = 1e-4;

/// Appends states from `begin` to `end` at the update rate, the first at `begin`.
void hold(std::vector<TimedState>& states, const engine::ContactState& state, double begin, double end) {
    for (int update = 0; begin + update * updateSeconds < end - minimumSeconds; ++update) {
        states.push_back({begin + update * updateSeconds, state});
    }
}

}  // namespace

TouchScript touchScript(const Hand& hand, const DeviceShape& shape, std::size_t touches, std::uint32_t firstTouch,
                        std::mt19937_64& random) {
    const double period = shape.periodSeconds();
    std::uniform_real_distribution<double> phase(0.0, std::max(period, updateSeconds));
    std::uniform_int_distribution<std::size_t> place(0, hand.labelCount() - 1);
    TouchScript script;
    double now = 0.0;
    std::uint32_t counter = firstTouch;
    hold(script.states, Hand::lifted(counter - 1), now, quietSeconds);
    now = quietSeconds;
    for (std::size_t index = 0; index < touches; ++index, ++counter) {
        // A period each for the start and the end of the sound, and 5 ms for the fade.
        const double touchSeconds = period + 0.03 + phase(random);
        const double pauseSeconds = period + 0.02 + phase(random);
        Touch touch;
        touch.down = script.states.size();
        hold(script.states, hand.sliding(counter, place(random)), now, now + touchSeconds);
        now += touchSeconds;
        touch.lift = script.states.size();
        hold(script.states, Hand::lifted(counter), now, now + pauseSeconds);
        now += pauseSeconds;
        script.touches.push_back(touch);
    }
    script.states.push_back({now, Hand::lifted(counter - 1)});
    return script;
}

StepScript stepScript(const Hand& hand, const DeviceShape& shape, std::size_t steps, std::uint32_t firstTouch,
                      std::mt19937_64& random) {
    // A change must have sounded before the next one.
    const auto updates = std::max(4.0, std::ceil((2.0 * shape.periodSeconds() + 0.03) / updateSeconds));
    const double holdSeconds = updates * updateSeconds;
    std::uniform_real_distribution<double> phase(0.0, updateSeconds);
    StepScript script;
    double now = 0.0;
    std::uint32_t counter = firstTouch;
    hold(script.states, Hand::lifted(counter - 1), now, quietSeconds);
    now = quietSeconds;
    while (script.steps.size() < steps) {
        // A hand publishes at the update rate throughout a touch, so each label lasts a whole number of updates.
        for (std::size_t change = 0; change < 2 * stepsOfAStroke; ++change) {
            const std::size_t place = change % 2;
            if (place == 1) {
                script.steps.push_back(script.states.size());
            }
            hold(script.states, hand.sliding(counter, place), now, now + holdSeconds);
            now += holdSeconds;
        }
        // Strokes begin at any phase of the device's blocks.
        const double pauseSeconds = shape.periodSeconds() + 0.02 + phase(random);
        hold(script.states, Hand::lifted(counter), now, now + pauseSeconds);
        now += pauseSeconds;
        ++counter;
    }
    script.states.push_back({now, Hand::lifted(counter - 1)});
    return script;
}

std::vector<double> playScript(engine::LiveEngine& engine, engine::LiveVoice& voice,
                               const std::vector<TimedState>& states) {
    std::vector<double> published;
    published.reserve(states.size());
    const double start = nowSeconds();
    for (const TimedState& timed : states) {
        sleepUntil(start + timed.seconds);
        published.push_back(nowSeconds());
        engine.publish(voice, timed.state);
    }
    return published;
}

}  // namespace haptoflow::bench
