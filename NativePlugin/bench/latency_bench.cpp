#include "bench/latency_bench.hpp"

#include "bench/distribution.hpp"
#include "bench/marking.hpp"
#include "bench/real_time_device.hpp"
#include "dsp/waveform_resampler.hpp"

#include <algorithm>
#include <utility>

namespace haptoflow::bench {
namespace {

constexpr std::size_t eventsPerRound = 25;
// Rounds in addition to the needed ones, for events that a busy machine loses.
constexpr std::size_t spareRounds = 3;

struct DeviceRun {
    DeviceShape shape;
    Latencies latencies;
    std::size_t lateCalls = 0;
};

struct Measured {
    std::vector<DeviceRun> onsets;
    std::vector<DeviceRun> stops;
    std::vector<DeviceRun> steps;
};

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

void measureTouches(const Subjects& subjects, const DeviceShape& shape, std::size_t events, Measured& measured) {
    const Hand hand(*subjects.model);
    Rig rig(subjects.standardEngine(true));
    std::mt19937_64 random(subjects.seed);
    std::uint32_t firstTouch = 1;
    DeviceRun onsets{.shape = shape, .latencies = {}};
    DeviceRun stops = onsets;
    inRounds(
        events, "touch",
        [&](std::size_t count) {
            const TouchScript script = touchScript(hand, shape, count, firstTouch, random);
            firstTouch += static_cast<std::uint32_t>(count);
            const auto [recording, published] = rig.play(shape, script.states);
            findOnsets(recording, published, script, shape, onsets.latencies);
            findStops(recording, published, script, shape, stops.latencies);
            onsets.lateCalls += recording.lateCalls;
        },
        [&] { return std::min(onsets.latencies.seconds.size(), stops.latencies.seconds.size()); });
    stops.lateCalls = onsets.lateCalls;
    measured.onsets.push_back(std::move(onsets));
    measured.stops.push_back(std::move(stops));
}

double filterDelaySeconds() {
    const dsp::WaveformResampler resampler(outputRateHz);
    constexpr double lowFrequencyHz = 50.0;
    return resampler.groupDelaySeconds(lowFrequencyHz);
}

void measureSteps(const Subjects& subjects, const DeviceShape& shape, std::size_t events, Measured& measured) {
    const Hand hand(*subjects.model);
    const skeleton::NativeParts marking = markingParts(*subjects.model, hand.label(0), hand.label(1));
    auto standard = subjects.generator(*subjects.model, subjects.standard(), 1);
    Rig rig(subjects.engineWith(std::make_unique<MarkingGenerator>(std::move(standard), marking), true, marking));
    std::mt19937_64 random(subjects.seed);
    std::uint32_t firstTouch = 1;
    DeviceRun steps{.shape = shape, .latencies = {}};
    const double filterSeconds = filterDelaySeconds();
    inRounds(
        events, "label step",
        [&](std::size_t count) {
            const StepScript script = stepScript(hand, shape, count, firstTouch, random);
            firstTouch += static_cast<std::uint32_t>(script.states.size());
            const auto [recording, published] = rig.play(shape, script.states);
            findSteps(recording, published, script, shape, filterSeconds, engine::LiveEngineSettings{}.fullScaleMps2,
                      steps.latencies);
            steps.lateCalls += recording.lateCalls;
        },
        [&] { return steps.latencies.seconds.size(); });
    measured.steps.push_back(std::move(steps));
}

double shareWithin(const Latencies& latencies, double allowanceSeconds) {
    std::size_t within = 0;
    for (std::size_t index = 0; index < latencies.seconds.size(); ++index) {
        within += latencies.seconds[index] <= latencies.goalSeconds[index] + allowanceSeconds ? 1 : 0;
    }
    return static_cast<double>(within) / static_cast<double>(latencies.seconds.size());
}

nlohmann::ordered_json rowOf(const DeviceRun& run) {
    nlohmann::ordered_json row{{"block_frames", run.shape.blockFrames}, {"burst_blocks", run.shape.burstBlocks}};
    const Distribution latency = distributionOf(run.latencies.seconds);
    row.update(toJson(latency, milliseconds));
    const double goal = rounded(distributionOf(run.latencies.goalSeconds).p50 * milliseconds);
    row["goal"] = goal;
    row["ratio"] = ratioOf(row["p99"].get<double>(), goal);
    row["within_goal"] = rounded(shareWithin(run.latencies, 0.0));
    row["missed"] = run.latencies.missed;
    row["late_calls"] = run.lateCalls;
    return row;
}

/// The figures of the default device, followed by those of every device.
nlohmann::ordered_json sectionOf(const std::vector<nlohmann::ordered_json>& rows) {
    nlohmann::ordered_json section = rows.front();
    section["rows"] = rows;
    return section;
}

nlohmann::ordered_json stepRow(const DeviceRun& run) {
    nlohmann::ordered_json row = rowOf(run);
    row["filter_delay"] = rounded(filterDelaySeconds() * milliseconds);
    return row;
}

}  // namespace

nlohmann::ordered_json measureLatency(const Subjects& subjects, const BenchPlan& plan, const Advance& advance) {
    const bool canStep = subjects.model->header().skeleton && Hand(*subjects.model).labelCount() > 1;
    Measured measured;
    double done = 0.0;
    const auto share = 1.0 / static_cast<double>(2 * plan.devices.size());
    for (const DeviceShape& shape : plan.devices) {
        measureTouches(subjects, shape, plan.events, measured);
        advance(done += share);
        if (canStep) {
            measureSteps(subjects, shape, plan.events, measured);
        }
        advance(done += share);
    }
    const auto rowsOf = [](const std::vector<DeviceRun>& runs, auto toRow) {
        std::vector<nlohmann::ordered_json> rows;
        std::ranges::transform(runs, std::back_inserter(rows), toRow);
        return rows;
    };
    nlohmann::ordered_json report;
    report["onset_ms"] = sectionOf(rowsOf(measured.onsets, rowOf));
    if (canStep) {
        report["contact_to_sound_ms"] = sectionOf(rowsOf(measured.steps, stepRow));
    }
    report["stop_ms"] = sectionOf(rowsOf(measured.stops, rowOf));
    return report;
}

}  // namespace haptoflow::bench
