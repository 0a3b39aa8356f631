#include "bench/measurements.hpp"

#include "bench/distribution.hpp"
#include "effects/actuator_profile.hpp"
#include "effects/effect.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <random>
#include <span>
#include <utility>
#include <vector>

namespace haptoflow::bench {
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

struct NamedEffect {
    const char* name;
    EffectKind kind;
};

constexpr std::array<NamedEffect, 8> measuredEffects{{{"texture", EffectKind::texture},
                                                      {"tone", EffectKind::tone},
                                                      {"impact", EffectKind::impact},
                                                      {"edge", EffectKind::edge},
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

    void publish(double seconds) {
        const auto touch = 1U + static_cast<std::uint32_t>(seconds * landingsPerSecond);
        const auto place = static_cast<std::size_t>(seconds * crossingsPerSecond) % hand_.labelCount();
        engine::ContactState state = hand_.sliding(touch, place);
        state.approachSpeedMps = approachSpeedMps;
        state.edgeCounter = static_cast<std::uint32_t>(seconds * crossingsPerSecond);
        state.edgeHeightMetres = edgeHeightMetres;
        const bool isOfSurface = kind_ <= EffectKind::edge;
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
        const double blocks = static_cast<double>(withSeconds_.size());
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

    /// For the texture: the network's runs and their time, which the worker spends and not the callback.
    [[nodiscard]] Runs runsOf(const engine::LiveVoice& voice) const {
        const engine::VoiceCounters& all = voice.channels.counters;
        if (kind_ == EffectKind::texture) {
            return {all.inferences, all.onsets, all.inferenceNanoseconds};
        }
        const engine::EffectCounters& own = all.effects.at(static_cast<std::size_t>(kind_));
        return {own.runs, own.events, own.nanoseconds};
    }

    EffectKind kind_;
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

}  // namespace haptoflow::bench
