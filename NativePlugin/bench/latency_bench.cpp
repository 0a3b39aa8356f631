#include "bench/latency_bench.hpp"

#include "bench/measurements.hpp"
#include "dsp/waveform_resampler.hpp"
#include "skeleton/condition.hpp"
#include "skeleton/skeleton.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

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

namespace {

using skeleton::LinearLayer;

LinearLayer zeros(std::size_t outputs, std::size_t inputs) {
    return {std::vector<float>(outputs * inputs), std::vector<float>(outputs)};
}

skeleton::HiddenLayers silentHidden(std::size_t inputs) {
    return {zeros(1, inputs), zeros(1, 1)};
}

/// A law whose level is linear in the embedding, quiet at one and loud at another.
LinearLayer markingLaw(std::span<const float> quiet, std::span<const float> loud) {
    double apart = 0.0;
    double place = 0.0;
    for (std::size_t i = 0; i < quiet.size(); ++i) {
        const double difference = static_cast<double>(loud[i]) - static_cast<double>(quiet[i]);
        apart += difference * difference;
        place += difference * static_cast<double>(quiet[i]);
    }
    if (!(apart > 0.0)) {
        throw MeasurementError("the model's first two labels are the same material");
    }
    const double rise = std::log(static_cast<double>(loudMps2) / static_cast<double>(quietMps2)) / apart;
    std::vector<float> weight(3 * quiet.size());
    for (std::size_t i = 0; i < quiet.size(); ++i) {
        weight[i] = static_cast<float>(rise * (static_cast<double>(loud[i]) - static_cast<double>(quiet[i])));
    }
    const auto bias = static_cast<float>(std::log(static_cast<double>(quietMps2)) - rise * place);
    return {weight, std::array<float, 3>{bias, 0.0F, 0.0F}};
}

}  // namespace

skeleton::NativeParts markingParts(const model::ModelFile& model, std::uint32_t quiet, std::uint32_t loud) {
    constexpr std::size_t familyOutputs = 2 * (skeleton::swingHarmonics + skeleton::lineHarmonics);
    const skeleton::Perceptron correction(silentHidden(skeleton::LevelModel::correctionInputs), zeros(1, 1));
    return {.level = std::make_shared<const skeleton::LevelModel>(
                markingLaw(model.embedding(quiet), model.embedding(loud)), correction),
            .skeleton = std::make_shared<const skeleton::Skeleton>(
                silentHidden(skeleton::Condition{}.size()),
                skeleton::OutputLayers{
                    .filter = zeros(skeleton::filterOrder + 1, 1),
                    .families = {zeros(familyOutputs, 1), zeros(familyOutputs, 1), zeros(familyOutputs, 1)},
                    .impulseGains = zeros(skeleton::TailImpulses::gainCount, 1)})};
}

namespace {

constexpr float minus60Db = 1e-3F;
constexpr double releaseSeconds = 0.005;
constexpr double soundingSeconds = 0.0015;

/// The time at which the next touch begins, or the end of the script after the last touch.
double nextDown(const std::vector<double>& published, const TouchScript& script, std::size_t touch) {
    return touch + 1 < script.touches.size() ? published[script.touches[touch + 1].down] : published.back();
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

void findOnsets(const Recording& recording, const std::vector<double>& published, const TouchScript& script,
                const DeviceShape& shape, Latencies& onsets) {
    for (std::size_t touch = 0; touch < script.touches.size(); ++touch) {
        const double down = published[script.touches[touch].down];
        const double end = nextDown(published, script, touch);
        const float peak = recording.peak(down, end);
        note(peak > 0.0F ? recording.first(peak * minus60Db, down, end) : std::nullopt, down, shape.periodSeconds(),
             onsets);
    }
}

void findStops(const Recording& recording, const std::vector<double>& published, const TouchScript& script,
               const DeviceShape& shape, Latencies& stops) {
    for (std::size_t touch = 0; touch < script.touches.size(); ++touch) {
        const double down = published[script.touches[touch].down];
        const double lift = published[script.touches[touch].lift];
        const double end = nextDown(published, script, touch);
        const float peak = recording.peak(down, end);
        auto last = peak > 0.0F ? recording.last(peak * minus60Db, lift, end) : std::nullopt;
        if (last) {
            *last += 1.0 / recording.rateHz;
        }
        note(last, lift, shape.periodSeconds() + releaseSeconds, stops);
    }
}

void findSteps(const Recording& recording, const std::vector<double>& published, const StepScript& script,
               const DeviceShape& shape, double filterSeconds, float fullScaleMps2, Latencies& steps) {
    // A tenth of the loud label's RMS. Nearly every sample of the loud label exceeds it, no sample of the quiet one
    // does.
    constexpr float recognised = 0.1F * loudMps2;
    // Longer than any period of a device: after this time the change of label was lost.
    constexpr double maximumSeconds = 0.3;
    for (const std::size_t step : script.steps) {
        const double stepped = published[step];
        note(recording.first(recognised / fullScaleMps2, stepped, stepped + maximumSeconds), stepped,
             shape.periodSeconds() + filterSeconds + soundingSeconds, steps);
    }
}

namespace {

constexpr std::size_t eventsPerRound = 25;
// Rounds in addition to the needed ones, for events that a busy machine loses.
constexpr std::size_t spareRounds = 3;

using Rows = std::vector<nlohmann::ordered_json>;

/// An engine with its worker and one voice, for any number of recordings.
class Rig {
public:
    explicit Rig(std::unique_ptr<engine::LiveEngine> engine)
        : engine_(std::move(engine)), voice_(engine_->addVoice(outputRateHz)) {}

    [[nodiscard]] std::pair<Recording, std::vector<double>> play(const DeviceShape& shape,
                                                                 const std::vector<TimedState>& states) {
        // Room for a machine that is late.
        RealTimeDevice device(shape, states.back().seconds + 2.0,
                              [this](std::span<float> block) { voice_->renderer.render(block, outputRateHz); });
        auto published = playScript(*engine_, *voice_, states);
        return {device.finish(), std::move(published)};
    }

private:
    std::unique_ptr<engine::LiveEngine> engine_;
    std::shared_ptr<engine::LiveVoice> voice_;
};

/// Calls `round(events)` until `measured()` has reached `wanted`, or until too many rounds have lost events.
template <typename Round, typename Count>
void inRounds(std::size_t wanted, const char* what, Round round, Count measured) {
    const std::size_t rounds = (wanted + eventsPerRound - 1) / eventsPerRound + spareRounds;
    for (std::size_t index = 0; index < rounds && measured() < wanted; ++index) {
        round(std::min(eventsPerRound, wanted - measured()));
    }
    if (measured() == 0) {
        throw MeasurementError(std::string("no ") + what +
                               " was found in the simulated device's recording: the model is silent, or the machine is "
                               "too busy");
    }
}

double shareWithin(const Latencies& latencies, double allowanceSeconds) {
    std::size_t within = 0;
    for (std::size_t index = 0; index < latencies.seconds.size(); ++index) {
        within += latencies.seconds[index] <= latencies.goalSeconds[index] + allowanceSeconds ? 1 : 0;
    }
    return static_cast<double>(within) / static_cast<double>(latencies.seconds.size());
}

nlohmann::ordered_json rowOf(const DeviceShape& shape, const Latencies& latencies, std::size_t lateCalls) {
    nlohmann::ordered_json row{{"block_frames", shape.blockFrames}, {"burst_blocks", shape.burstBlocks}};
    row.update(toJson(distributionOf(latencies.seconds), milliseconds));
    const double goal = rounded(distributionOf(latencies.goalSeconds).p50 * milliseconds);
    row["goal"] = goal;
    row["ratio"] = ratioOf(row["p99"].get<double>(), goal);
    row["within_goal"] = rounded(shareWithin(latencies, 0.0));
    row["missed"] = latencies.missed;
    row["late_calls"] = lateCalls;
    return row;
}

void measureTouches(const Subjects& subjects, const DeviceShape& shape, std::size_t events, Rows& onsetRows,
                    Rows& stopRows) {
    const Hand hand(*subjects.model);
    Rig rig(subjects.standardEngine(true));
    std::mt19937_64 random(subjects.seed);
    std::uint32_t firstTouch = 1;
    Latencies onsets;
    Latencies stops;
    std::size_t lateCalls = 0;
    inRounds(
        events, "touch",
        [&](std::size_t count) {
            const TouchScript script = touchScript(hand, shape, count, firstTouch, random);
            firstTouch += static_cast<std::uint32_t>(count);
            const auto [recording, published] = rig.play(shape, script.states);
            findOnsets(recording, published, script, shape, onsets);
            findStops(recording, published, script, shape, stops);
            lateCalls += recording.lateCalls;
        },
        [&] { return std::min(onsets.seconds.size(), stops.seconds.size()); });
    onsetRows.push_back(rowOf(shape, onsets, lateCalls));
    stopRows.push_back(rowOf(shape, stops, lateCalls));
}

double filterDelaySeconds() {
    const dsp::WaveformResampler resampler(outputRateHz);
    constexpr double lowFrequencyHz = 50.0;
    return resampler.groupDelaySeconds(lowFrequencyHz);
}

nlohmann::ordered_json measureSteps(const Subjects& subjects, const DeviceShape& shape, std::size_t events) {
    const Hand hand(*subjects.model);
    const skeleton::NativeParts marking = markingParts(*subjects.model, hand.label(0), hand.label(1));
    auto standard = subjects.generator(*subjects.model, subjects.standard(), 1);
    Rig rig(subjects.engineWith(std::make_unique<MarkingGenerator>(std::move(standard), marking), true, marking));
    std::mt19937_64 random(subjects.seed);
    std::uint32_t firstTouch = 1;
    Latencies steps;
    std::size_t lateCalls = 0;
    const double filterSeconds = filterDelaySeconds();
    inRounds(
        events, "label step",
        [&](std::size_t count) {
            const StepScript script = stepScript(hand, shape, count, firstTouch, random);
            firstTouch += static_cast<std::uint32_t>(script.states.size());
            const auto [recording, published] = rig.play(shape, script.states);
            findSteps(recording, published, script, shape, filterSeconds, engine::LiveEngineSettings{}.fullScaleMps2,
                      steps);
            lateCalls += recording.lateCalls;
        },
        [&] { return steps.seconds.size(); });
    nlohmann::ordered_json row = rowOf(shape, steps, lateCalls);
    row["filter_delay"] = rounded(filterSeconds * milliseconds);
    return row;
}

/// The figures of the default device, followed by those of every device.
nlohmann::ordered_json sectionOf(const Rows& rows) {
    nlohmann::ordered_json section = rows.front();
    section["rows"] = rows;
    return section;
}

}  // namespace

nlohmann::ordered_json measureLatency(const Subjects& subjects, const BenchPlan& plan, const Advance& advance) {
    const bool canStep = subjects.model->header().skeleton && Hand(*subjects.model).labelCount() > 1;
    Rows onsets;
    Rows stops;
    Rows steps;
    double done = 0.0;
    const auto share = 1.0 / static_cast<double>(2 * plan.devices.size());
    for (const DeviceShape& shape : plan.devices) {
        measureTouches(subjects, shape, plan.events, onsets, stops);
        advance(done += share);
        if (canStep) {
            steps.push_back(measureSteps(subjects, shape, plan.events));
        }
        advance(done += share);
    }
    nlohmann::ordered_json report;
    report["onset_ms"] = sectionOf(onsets);
    if (canStep) {
        report["contact_to_sound_ms"] = sectionOf(steps);
    }
    report["stop_ms"] = sectionOf(stops);
    return report;
}

}  // namespace haptoflow::bench
