#include "bench/measurements.hpp"
#include "bench/real_time_device.hpp"
#include "effects/actuator_profile.hpp"
#include "effects/clip_sound.hpp"
#include "effects/effect.hpp"
#include "effects/relief_map.hpp"
#include "engine/relief_table.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <random>
#include <span>
#include <utility>
#include <vector>

namespace haptoflow::bench {
namespace {

using Voices = std::vector<std::shared_ptr<engine::LiveVoice>>;

/// Sliding voices of one engine and as many untouched ones, rendered and timed separately.
class SlidingAndSilentVoices {
public:
    SlidingAndSilentVoices(const Subjects& subjects, std::size_t voices, bool hasWorker)
        : hand_(*subjects.model), engine_(subjects.standardEngine(hasWorker)), order_(subjects.seed) {
        for (std::size_t voice = 0; voice < voices; ++voice) {
            sliding_.push_back(engine_->addVoice(outputRateHz));
            silent_.push_back(engine_->addVoice(outputRateHz));
        }
    }

    /// Publishes a state for every voice; the speeds vary between a tenth and a half of the recorded range.
    void publish(double seconds) {
        for (std::size_t voice = 0; voice < sliding_.size(); ++voice) {
            const auto phase = static_cast<double>(voice);
            const double speedShare = 0.3 + 0.2 * std::sin(3.0 * seconds + phase);
            engine_->publish(*sliding_[voice], hand_.sliding(1, voice % hand_.labelCount(), speedShare));
            engine_->publish(*silent_[voice], Hand::lifted(0));
        }
    }

    void step() { engine_->step(); }

    /// Renders one block of each kind of voice, in random order, and records both times, also those of the first
    /// blocks.
    void render(std::span<float> block) {
        std::array<double, 2> seconds{};
        const std::size_t first = order_() % 2;
        for (const std::size_t kind : {first, 1 - first}) {
            seconds.at(kind) = secondsOf([&] {
                for (const auto& voice : kind == 0 ? sliding_ : silent_) {
                    voice->renderer.render(block, outputRateHz);
                }
            });
        }
        ++blocks_;
        slidingSeconds_.push_back(seconds[0]);
        silentSeconds_.push_back(seconds[1]);
    }

    [[nodiscard]] nlohmann::ordered_json figures() const {
        if (slidingSeconds_.empty()) {
            throw MeasurementError(
                "the simulated device was called too rarely to be measured: the machine is too busy");
        }
        std::uint64_t underruns = 0;
        for (const auto& voice : sliding_) {
            const engine::VoiceCounters& counters = voice->channels.counters;
            if (counters.onsets == 0) {
                throw MeasurementError("a voice that should slide was silent: its callback was not measured");
            }
            underruns += counters.underruns;
        }
        const double blockMicroseconds = DeviceShape{}.blockSeconds() * microseconds;
        nlohmann::ordered_json figures = toJson(distributionOf(slidingSeconds_), microseconds);
        nlohmann::ordered_json percent;
        for (const char* rank : {"p50", "p99", "worst"}) {
            percent[rank] = rounded(100.0 * figures[rank].get<double>() / blockMicroseconds);
        }
        figures["percent_of_block"] = percent;
        figures["silence"] = toJson(distributionOf(silentSeconds_), microseconds);
        figures["ratio"] = ratioOf(figures["p50"].get<double>(), figures["silence"]["p50"].get<double>());
        figures["underruns"] = underruns;
        return figures;
    }

    /// Number of blocks rendered so far. Any thread may ask.
    [[nodiscard]] std::size_t blocks() const noexcept { return blocks_; }
    void reserve(std::size_t blocks) {
        slidingSeconds_.reserve(blocks);
        silentSeconds_.reserve(blocks);
    }

private:
    Hand hand_;
    std::unique_ptr<engine::LiveEngine> engine_;
    Voices sliding_;
    Voices silent_;
    std::minstd_rand order_;
    std::atomic<std::size_t> blocks_{0};
    std::vector<double> slidingSeconds_;
    std::vector<double> silentSeconds_;
};

nlohmann::ordered_json measureHot(const Subjects& subjects, std::size_t voices, std::size_t blocks) {
    SlidingAndSilentVoices voicePairs(subjects, voices, false);
    voicePairs.reserve(blocks);
    std::vector<float> block(defaultBlockFrames);
    simulateBlocks(
        blocks,
        [&](double now) {
            voicePairs.publish(now);
            voicePairs.step();
        },
        [&] { voicePairs.render(block); });
    return voicePairs.figures();
}

nlohmann::ordered_json measurePaced(const Subjects& subjects, std::size_t voices, double seconds) {
    const DeviceShape shape;
    const auto wanted = static_cast<std::size_t>(std::ceil(seconds / shape.blockSeconds()));
    // A machine that is busy with other work needs more time for the same number of blocks.
    const double maximumSeconds = 1.0 + 5.0 * static_cast<double>(wanted) * shape.blockSeconds();
    SlidingAndSilentVoices voicePairs(subjects, voices, true);
    voicePairs.reserve(static_cast<std::size_t>(maximumSeconds / shape.blockSeconds()) + 1);
    const double start = nowSeconds();
    RealTimeDevice device(shape, maximumSeconds, [&voicePairs](std::span<float> block) { voicePairs.render(block); });
    for (int update = 1; voicePairs.blocks() < wanted && nowSeconds() < start + maximumSeconds; ++update) {
        voicePairs.publish(nowSeconds() - start);
        sleepUntil(start + update / updateRateHz);
    }
    const std::size_t lateCalls = device.finish().lateCalls;
    nlohmann::ordered_json figures = voicePairs.figures();
    figures["late_calls"] = lateCalls;
    return figures;
}

}  // namespace

nlohmann::ordered_json measureCallback(const Subjects& subjects, const BenchPlan& plan, const Advance& advance) {
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    for (const std::size_t voices : plan.callbackVoices) {
        nlohmann::ordered_json row{{"voices", voices}};
        row.update(measureHot(subjects, voices, plan.callbackBlocks()));
        row["paced"] = measurePaced(subjects, voices, plan.callbackPacedSeconds());
        rows.push_back(std::move(row));
        advance(static_cast<double>(rows.size()) / static_cast<double>(plan.callbackVoices.size()));
    }
    return {{"callback_us", rows}};
}

namespace {

using effects::EffectKind;
using effects::maskOf;

constexpr double landingsPerSecond = 5.0;
constexpr double crossingsPerSecond = 10.0;
constexpr float approachSpeedMps = 0.3F;
constexpr float edgeHeightMetres = 0.001F;
constexpr double delaySeconds = 0.1;
constexpr float tiltDbPerOctave = 3.0F;
constexpr effects::SignalSettings studySignal{.frequencyHz = 200.0F, .amplitudeMps2 = 6.0F};

/// A map of rough ground, of a texel a quarter of a millimetre long.
std::shared_ptr<const effects::ReliefMap> roughMap() {
    constexpr std::uint32_t texels = 512;
    constexpr double sizeMetres = 0.128;
    constexpr float depthMetres = 0.0005F;
    std::vector<float> heightsMetres(std::size_t{texels} * texels);
    std::minstd_rand random(1);
    std::uniform_real_distribution<float> uniform(0.0F, depthMetres);
    std::ranges::generate(heightsMetres, [&] { return uniform(random); });
    return std::make_shared<const effects::ReliefMap>(
        heightsMetres, effects::ReliefDescription{.columns = texels,
                                                  .rows = texels,
                                                  .sizeMetres = {sizeMetres, sizeMetres},
                                                  .depthMetres = static_cast<double>(depthMetres),
                                                  .tipRadiusMetres = static_cast<double>(depthMetres),
                                                  .isTiled = true});
}

/// A second.
constexpr auto clipSamples = static_cast<std::size_t>(effects::ClipSound::waveRateHz);

struct NamedEffect {
    const char* name;
    EffectKind kind;
};

constexpr std::array<NamedEffect, 10> measuredEffects{{{"texture", EffectKind::texture},
                                                       {"tone", EffectKind::tone},
                                                       {"impact", EffectKind::impact},
                                                       {"edge", EffectKind::edge},
                                                       {"relief", EffectKind::relief},
                                                       {"clip", EffectKind::clip},
                                                       {"delay", EffectKind::delay},
                                                       {"compensation", EffectKind::compensation},
                                                       {"exposure guard", EffectKind::exposureGuard},
                                                       {"signal", EffectKind::signal}}};

/// Two voices in the same state, with and without the effect, rendered and timed separately.
class WithAndWithout {
public:
    WithAndWithout(const Subjects& subjects, EffectKind kind)
        : kind_(kind),
          hand_(*subjects.model),
          engine_(subjects.standardEngine(false)),
          with_(engine_->addVoice(outputRateHz)),
          without_(engine_->addVoice(outputRateHz)),
          order_(subjects.seed) {
        with_->channels.controls.delaySeconds = delaySeconds;
        if (kind == EffectKind::signal) {
            with_->channels.controls.signal = studySignal;
        }
        if (kind == EffectKind::clip) {
            with_->channels.clip.draft() = {.wave = std::make_shared<const std::vector<float>>(clipSamples, 1.0F),
                                            .isLoop = true,
                                            .publishedSeconds = with_->channels.clock()};
            with_->channels.clip.post();
        }
        engine_->changeProcessors(*with_, [kind](engine::ProcessorSettings& settings) {
            settings.hasDelay = kind == EffectKind::delay;
            settings.hasExposureGuard = kind == EffectKind::exposureGuard;
            if (kind == EffectKind::compensation) {
                settings.actuator = std::make_shared<const effects::ActuatorProfile>(
                    effects::ActuatorProfile::builtIn("voice-coil").value());
            }
            return kind == EffectKind::delay || kind == EffectKind::exposureGuard || kind == EffectKind::compensation;
        });
    }

    WithAndWithout(const WithAndWithout&) = delete;
    WithAndWithout& operator=(const WithAndWithout&) = delete;
    ~WithAndWithout() { engine::reliefs().remove(relief_); }

    void publish(double seconds) {
        const auto touch = 1U + static_cast<std::uint32_t>(seconds * landingsPerSecond);
        const auto place = static_cast<std::size_t>(seconds * crossingsPerSecond) % hand_.labelCount();
        engine::ContactState state = hand_.sliding(touch, place);
        state.approachSpeedMps = approachSpeedMps;
        state.edgeCounter = static_cast<std::uint32_t>(seconds * crossingsPerSecond);
        state.edgeHeightMetres = edgeHeightMetres;
        const bool isOfSurface = kind_ <= EffectKind::edge || kind_ == EffectKind::relief;
        state.relief = relief_;
        state.reliefPlace = {static_cast<float>(seconds), 0.0F};
        state.reliefShare = 0.5F;
        // Both voices request the texture, unless the texture or the signal, which replaces it, is measured.
        const bool isAlone = kind_ == EffectKind::texture || kind_ == EffectKind::signal;
        state.effects = isAlone ? 0U : maskOf(EffectKind::texture);
        engine_->publish(*without_, state);
        state.effects |= isOfSurface ? maskOf(kind_) : 0U;
        state.toneDbPerOctave = kind_ == EffectKind::tone ? tiltDbPerOctave : 0.0F;
        engine_->publish(*with_, state);
        engine_->step();
    }

    /// Renders one block of each voice, in random order.
    void render(std::span<float> block) {
        const bool isFirst = order_() % 2 == 0;
        for (const bool isWith : {isFirst, !isFirst}) {
            engine::LiveVoice& voice = isWith ? *with_ : *without_;
            const double seconds = secondsOf([&] { voice.renderer.render(block, outputRateHz); });
            (isWith ? withSeconds_ : withoutSeconds_).push_back(seconds);
        }
    }

    [[nodiscard]] nlohmann::ordered_json figures() const {
        const Runs with = runsOf(*with_);
        const Runs without = runsOf(*without_);
        if (with.runs == 0) {
            throw MeasurementError("a requested effect did not run: it was not measured");
        }
        const auto blocks = static_cast<double>(withSeconds_.size());
        const double ownMicroseconds = 1e-3 * static_cast<double>(with.nanoseconds) / blocks;
        const nlohmann::ordered_json callbackWith = toJson(distributionOf(withSeconds_), microseconds);
        const nlohmann::ordered_json callbackWithout = toJson(distributionOf(withoutSeconds_), microseconds);
        return {{"off", {{"runs", without.runs}, {"callback_us", callbackWithout}}},
                {"on",
                 {{"runs", with.runs},
                  {"events", with.events},
                  {"us_per_block", rounded(ownMicroseconds)},
                  {"share_of_block", rounded(ownMicroseconds / (DeviceShape{}.blockSeconds() * microseconds))},
                  {"callback_us", callbackWith},
                  {"ratio", ratioOf(callbackWith["p50"].get<double>(), callbackWithout["p50"].get<double>())}}}};
    }

private:
    struct Runs {
        std::uint64_t runs = 0;
        std::uint64_t events = 0;
        std::uint64_t nanoseconds = 0;
    };

    /// Of the texture, the network's runs and their time; the worker spends it, so it is no part of the callback's.
    [[nodiscard]] Runs runsOf(const engine::LiveVoice& voice) const {
        const engine::VoiceCounters& all = voice.channels.counters;
        if (kind_ == EffectKind::texture) {
            return {all.inferences, all.onsets, all.inferenceNanoseconds};
        }
        const engine::EffectCounters& own = all.effects.at(static_cast<std::size_t>(kind_));
        return {own.runs, own.events, own.nanoseconds};
    }

    EffectKind kind_;
    std::uint32_t relief_ = engine::reliefs().add(roughMap());
    Hand hand_;
    std::unique_ptr<engine::LiveEngine> engine_;
    std::shared_ptr<engine::LiveVoice> with_;
    std::shared_ptr<engine::LiveVoice> without_;
    std::minstd_rand order_;
    std::vector<double> withSeconds_;
    std::vector<double> withoutSeconds_;
};

nlohmann::ordered_json measure(const Subjects& subjects, EffectKind kind, std::size_t blocks) {
    WithAndWithout voices(subjects, kind);
    std::vector<float> block(defaultBlockFrames);
    simulateBlocks(
        blocks, [&](double now) { voices.publish(now); }, [&] { voices.render(block); });
    return voices.figures();
}

}  // namespace

nlohmann::ordered_json measureEffects(const Subjects& subjects, const BenchPlan& plan, const Advance& advance) {
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    for (const auto& [name, kind] : measuredEffects) {
        nlohmann::ordered_json row{{"name", name}};
        row.update(measure(subjects, kind, plan.callbackBlocks()));
        rows.push_back(std::move(row));
        advance(static_cast<double>(rows.size()) / static_cast<double>(measuredEffects.size()));
    }
    return {{"effects", rows}};
}

namespace {

constexpr int roundCount = 4;

struct Busy {
    double cpuSeconds = 0.0;
    double wallSeconds = 0.0;

    [[nodiscard]] double percent() const { return rounded(100.0 * cpuSeconds / wallSeconds); }
};

/// Runs two threads in real time: a device that calls `render`, and this thread, which calls `update`.
template <typename Render, typename Update>
void pass(double seconds, Busy& busy, Render render, Update update) {
    const double cpuBefore = processCpuSeconds();
    const double start = nowSeconds();
    {
        const RealTimeDevice device(DeviceShape{}, 2.0 * seconds, render);
        int count = 0;
        do {
            update();
            ++count;
            sleepUntil(start + count / updateRateHz);
        } while (nowSeconds() < start + seconds);
    }
    busy.wallSeconds += nowSeconds() - start;
    busy.cpuSeconds += processCpuSeconds() - cpuBefore;
}

}  // namespace

nlohmann::ordered_json measureIdle(const Subjects& subjects, const BenchPlan& plan, const Advance& advance) {
    const auto engine = subjects.standardEngine(true);
    const auto voice = engine->addVoice(outputRateHz);
    const std::uint64_t wakesBefore = engine->statistics().wakes;
    Busy idle;
    Busy reference;
    const double seconds = plan.idleSeconds() / roundCount;
    for (int round = 0; round < roundCount; ++round) {
        pass(
            seconds, reference, [](std::span<float> block) { std::ranges::fill(block, 0.0F); }, [] {});
        pass(
            seconds, idle, [&voice](std::span<float> block) { voice->renderer.render(block, outputRateHz); },
            [&] { engine->publish(*voice, Hand::lifted(0)); });
        advance((round + 1.0) / roundCount);
    }
    return {{"idle",
             {{"inferences", voice->channels.counters.inferences.load()},
              {"cpu_percent", idle.percent()},
              {"without_engine_cpu_percent", reference.percent()},
              {"ratio", ratioOf(idle.percent(), reference.percent())},
              {"worker_wakes", engine->statistics().wakes - wakesBefore},
              {"updates", voice->channels.counters.updates.load()},
              {"frames", voice->channels.counters.renderedFrames.load()}}}};
}

}  // namespace haptoflow::bench
