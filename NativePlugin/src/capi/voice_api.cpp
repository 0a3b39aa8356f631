#include "capi/handles.hpp"
#include "capi/voice_table.hpp"

#include <bit>
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

using namespace haptoflow;
using namespace haptoflow::capi;

using effects::EffectKind;

static_assert(engine::MaterialBlend::capacity == HAPTOFLOW_MAXIMUM_BLEND);
static_assert(effects::effectKinds == HAPTOFLOW_EFFECT_COUNT);
static_assert(static_cast<int>(effects::ExposureReason::dose) == HAPTOFLOW_EXPOSURE_DOSE);
static_assert(static_cast<int>(engine::Silence::turnedDown) == HAPTOFLOW_SILENCE_TURNED_DOWN);
static_assert(static_cast<int>(EffectKind::exposureGuard) == HAPTOFLOW_EFFECT_EXPOSURE_GUARD);
static_assert(static_cast<int>(EffectKind::tone) == HAPTOFLOW_EFFECT_TONE);
static_assert(static_cast<int>(EffectKind::signal) == HAPTOFLOW_EFFECT_SIGNAL);
static_assert(static_cast<int>(EffectKind::listen) == HAPTOFLOW_EFFECT_LISTEN);
static_assert(static_cast<int>(EffectKind::relief) == HAPTOFLOW_EFFECT_RELIEF);
static_assert(static_cast<int>(EffectKind::clip) == HAPTOFLOW_EFFECT_CLIP);
static_assert(effects::maskOf(EffectKind::relief) == HAPTOFLOW_ASKS_FOR_RELIEF);
static_assert(effects::maskOf(EffectKind::texture) == HAPTOFLOW_ASKS_FOR_TEXTURE);
static_assert(effects::maskOf(EffectKind::impact) == HAPTOFLOW_ASKS_FOR_IMPACT);
static_assert(effects::maskOf(EffectKind::edge) == HAPTOFLOW_ASKS_FOR_EDGE);

namespace {

/// engine::ContactState is the C struct after its size, so no field is copied by its name.
engine::ContactState contactState(const haptoflow_contact_state& given) {
    struct Sized {
        std::uint32_t structSize;
        engine::ContactState state;
    };
    static_assert(offsetof(Sized, state.material.weights) == offsetof(haptoflow_contact_state, weights));
    static_assert(offsetof(Sized, state.forceNewtons) == offsetof(haptoflow_contact_state, force_newtons));
    static_assert(offsetof(Sized, state.landingCounter) == offsetof(haptoflow_contact_state, landing_counter));
    static_assert(offsetof(Sized, state.reliefShare) == offsetof(haptoflow_contact_state, relief_share));
    engine::ContactState state = std::bit_cast<Sized>(given).state;
    state.effects = state.effects == 0 ? HAPTOFLOW_ASKS_FOR_TEXTURE : state.effects;
    return state;
}

effects::EffectMask effectsRequestedBySettings(engine::VoiceChannels& channels) {
    const std::lock_guard lock(channels.processorMutex);
    const engine::ProcessorSettings& settings = channels.processorSettings;
    return (settings.hasDelay ? effects::maskOf(EffectKind::delay) : 0U) |
           (settings.actuator != nullptr ? effects::maskOf(EffectKind::compensation) : 0U) |
           (settings.hasExposureGuard ? effects::maskOf(EffectKind::exposureGuard) : 0U) |
           (settings.listenFullScaleMps2 > 0.0 ? effects::maskOf(EffectKind::listen) : 0U) |
           (channels.controls.signal.load().isSet() ? effects::maskOf(EffectKind::signal) : 0U);
}

effects::ActuatorProfile readActuator(std::string_view text) {
    if (const auto builtIn = effects::ActuatorProfile::builtIn(text)) {
        return *builtIn;
    }
    try {
        return effects::ActuatorProfile::parse(text);
    } catch (const effects::ProfileError& error) {
        throw std::invalid_argument(std::string("profile: ") + error.what());
    }
}

float requireUnit(float value, const char* name) {
    if (!(value >= 0.0F && value <= 1.0F)) {
        throw std::invalid_argument(std::string(name) + " is " + std::to_string(value) + "; expected 0 to 1");
    }
    return value;
}

}  // namespace

haptoflow_status haptoflow_voice_create(haptoflow_engine* engine, double sample_rate_hz, haptoflow_voice* voice) {
    return guarded([&] {
        (void)require(voice, "voice");
        const auto open = engines().get(engine);
        const double rateHz = sample_rate_hz == 0.0 ? engine::LiveVoiceSettings{}.outputRateHz : sample_rate_hz;
        auto opened = std::make_unique<OpenVoice>();
        opened->engine = open->engine;
        opened->voice = open->engine->addVoice(rateHz);
        engine::LiveVoice& live = *opened->voice;
        try {
            *voice = voices().open(std::move(opened));
        } catch (...) {
            open->engine->removeVoice(live);
            throw;
        }
        // Another thread has begun to close the engine, and may have looked for its voices before this one was added.
        if (open->engine->isStopping()) {
            (void)voices().close(*voice);
            *voice = 0;
            throw std::invalid_argument("the engine is being closed");
        }
    });
}

haptoflow_status haptoflow_voice_destroy(haptoflow_voice* voice) {
    return guarded([&] {
        if (*require(voice, "voice") == 0) {
            return;
        }
        if (!voices().close(*voice)) {
            throw std::invalid_argument("not an open voice");
        }
        *voice = 0;
    });
}

haptoflow_status haptoflow_voice_publish(haptoflow_voice voice, const haptoflow_contact_state* state) {
    bool isBusy = false;
    const haptoflow_status status = guarded([&] {
        const auto given = readDescriptor(state, "state");
        const VoiceTable::Use use = requireVoice(voice);
        if (use->publishing.test_and_set(std::memory_order_acquire)) {
            use->refusedCalls.fetch_add(1, std::memory_order_relaxed);
            isBusy = true;
            return;
        }
        (void)use->engine->publish(*use->voice, contactState(given));
        use->publishing.clear(std::memory_order_release);
    });
    return isBusy ? HAPTOFLOW_BUSY : status;
}

haptoflow_status haptoflow_voice_render(haptoflow_voice voice, float* interleaved, uint32_t frame_count,
                                        uint32_t channel_count, int32_t channel, double sample_rate_hz) {
    const ChannelTarget target{interleaved, frame_count, channel_count, channel};
    if (!target.isValid()) {
        return HAPTOFLOW_INVALID_ARGUMENT;
    }
    return renderInto(voices().useToRender(voice), target, sample_rate_hz);
}

haptoflow_status haptoflow_voices_render(haptoflow_voice* voices, uint32_t voice_count, float* interleaved,
                                         uint32_t frame_count, uint32_t channel_count, int32_t channel,
                                         double sample_rate_hz) {
    const ChannelTarget target{interleaved, frame_count, channel_count, channel};
    if (!target.isValid() || (voices == nullptr && voice_count != 0)) {
        return HAPTOFLOW_INVALID_ARGUMENT;
    }
    return renderSum(capi::voices(), {voices, voice_count}, target, sample_rate_hz);
}

haptoflow_status haptoflow_voice_set_strength(haptoflow_voice voice, float strength) {
    return guarded([&] { requireVoice(voice)->voice->channels.controls.strength = requireUnit(strength, "strength"); });
}

haptoflow_status haptoflow_voice_set_ceiling(haptoflow_voice voice, float ceiling) {
    return guarded([&] { requireVoice(voice)->voice->channels.controls.ceiling = requireUnit(ceiling, "ceiling"); });
}

haptoflow_status haptoflow_voice_set_muted(haptoflow_voice voice, uint32_t muted) {
    return guarded([&] { requireVoice(voice)->voice->channels.controls.muted = muted != 0; });
}

haptoflow_status haptoflow_voice_set_paused(haptoflow_voice voice, uint32_t paused) {
    return guarded([&] { requireVoice(voice)->voice->channels.controls.paused = paused != 0; });
}

haptoflow_status haptoflow_voice_panic(haptoflow_voice voice) {
    return guarded([&] { requireVoice(voice)->voice->channels.panic(); });
}

haptoflow_status haptoflow_panic() {
    for (std::size_t place = 0; place < VoiceTable::capacity; ++place) {
        if (const VoiceTable::Use use = voices().useAt(place)) {
            use->voice->channels.panic();
        }
    }
    return HAPTOFLOW_OK;
}

haptoflow_status haptoflow_voice_get_statistics(haptoflow_voice voice, haptoflow_voice_statistics* statistics) {
    return guarded([&] {
        const VoiceTable::Use use = requireVoice(voice);
        const engine::VoiceCounters& counters = use->voice->channels.counters;
        haptoflow_voice_statistics content{};
        content.lead_samples = counters.leadSamples;
        content.updates = counters.updates;
        content.inferences = counters.inferences;
        content.skipped = counters.skipped;
        content.onsets = counters.onsets;
        content.taps = counters.taps;
        content.underruns = counters.underruns;
        content.late = counters.late;
        content.dropped = counters.dropped;
        content.failures = counters.failures;
        content.sanitised = counters.sanitised;
        content.stale_stops = counters.staleStops;
        content.non_finite_samples = counters.nonFiniteSamples;
        content.limited_samples = counters.limitedSamples;
        content.rendered_frames = counters.renderedFrames;
        content.rate_changes = counters.rateChanges;
        content.refused_calls = use->refusedCalls;
        content.inference_ms = static_cast<double>(counters.inferenceNanoseconds) * 1e-6;
        const engine::VoiceChannels& channels = use->voice->channels;
        content.resumptions = counters.resumptions;
        content.unsupported_rate_blocks = counters.unsupportedRateBlocks;
        content.device_rate_hz = channels.deviceRateHz;
        content.silence = static_cast<haptoflow_silence>(channels.silence.load());
        content.is_rate_supported = channels.isRateSupported ? 1 : 0;
        content.lost_contact_events = counters.lostEvents;
        content.sketched = counters.sketched;
        writeDescriptor(statistics, content, "statistics");
    });
}

haptoflow_status haptoflow_voice_set_delay(haptoflow_voice voice, double seconds) {
    return guarded([&] {
        if (!(seconds >= 0.0 && seconds <= effects::Delay::maximumSeconds)) {
            throw std::invalid_argument("seconds is " + std::to_string(seconds) + "; expected 0 to 0.5");
        }
        const VoiceTable::Use use = requireVoice(voice);
        use->voice->channels.controls.delaySeconds = seconds;
        use->engine->changeProcessors(*use->voice, [seconds](engine::ProcessorSettings& settings) {
            return std::exchange(settings.hasDelay, seconds > 0.0) != (seconds > 0.0);
        });
    });
}

haptoflow_status haptoflow_voice_set_signal(haptoflow_voice voice, double frequency_hz, double amplitude_mps2) {
    return guarded([&] {
        using Settings = effects::SignalSettings;
        if (!(amplitude_mps2 >= 0.0 && amplitude_mps2 <= Settings::maximumMps2)) {
            throw std::invalid_argument("amplitude_mps2 is " + std::to_string(amplitude_mps2) + "; expected 0 to 60");
        }
        Settings settings;
        if (amplitude_mps2 > 0.0) {
            if (!(frequency_hz >= Settings::minimumHz && frequency_hz <= Settings::maximumHz)) {
                throw std::invalid_argument("frequency_hz is " + std::to_string(frequency_hz) + "; expected 20 to 500");
            }
            settings = {static_cast<float>(frequency_hz), static_cast<float>(amplitude_mps2)};
        }
        requireVoice(voice)->voice->channels.controls.signal = settings;
    });
}

haptoflow_status haptoflow_voice_signal_statistics(haptoflow_voice voice, haptoflow_signal_statistics* statistics) {
    return guarded([&] {
        const VoiceTable::Use use = requireVoice(voice);
        const engine::VoiceCounters& counters = use->voice->channels.counters;
        haptoflow_signal_statistics content{};
        content.starts = counters.signalStarts.count;
        content.stops = counters.signalStops.count;
        content.last_start_latency_seconds = counters.signalStarts.lastSeconds;
        content.last_stop_latency_seconds = counters.signalStops.lastSeconds;
        content.mean_start_latency_seconds = counters.signalStarts.meanSeconds;
        content.mean_stop_latency_seconds = counters.signalStops.meanSeconds;
        writeDescriptor(statistics, content, "statistics");
    });
}

haptoflow_status haptoflow_voice_set_actuator(haptoflow_voice voice, const char* profile, uint64_t length) {
    return guarded([&] {
        const VoiceTable::Use use = requireVoice(voice);
        std::shared_ptr<const effects::ActuatorProfile> actuator;
        if (profile != nullptr) {
            actuator =
                std::make_shared<const effects::ActuatorProfile>(readActuator({profile, countOf(length, "length")}));
        }
        use->engine->changeProcessors(*use->voice, [&actuator](engine::ProcessorSettings& settings) {
            const bool isSame = settings.actuator == actuator || (settings.actuator != nullptr && actuator != nullptr &&
                                                                  *settings.actuator == *actuator);
            settings.actuator = std::move(actuator);
            return !isSame;
        });
    });
}

haptoflow_status haptoflow_voice_set_exposure_guard(haptoflow_voice voice, uint32_t is_on, float actuator_gain) {
    return guarded([&] {
        constexpr float largestGain = 1000.0F;
        if (!(actuator_gain >= 0.0F && actuator_gain <= largestGain)) {
            throw std::invalid_argument("actuator_gain is " + std::to_string(actuator_gain) + "; expected 0 to 1000");
        }
        const VoiceTable::Use use = requireVoice(voice);
        const double gain = actuator_gain == 0.0F ? 1.0 : static_cast<double>(actuator_gain);
        use->voice->channels.controls.actuatorGain = gain;
        use->engine->changeProcessors(*use->voice, [is_on](engine::ProcessorSettings& settings) {
            return std::exchange(settings.hasExposureGuard, is_on != 0) != (is_on != 0);
        });
    });
}

haptoflow_status haptoflow_voice_set_listen(haptoflow_voice voice, uint32_t is_on) {
    return guarded([&] {
        const VoiceTable::Use use = requireVoice(voice);
        const double fullScale = is_on != 0 ? use->engine->fullScaleMps2() : 0.0;
        use->engine->changeProcessors(*use->voice, [fullScale](engine::ProcessorSettings& settings) {
            return std::exchange(settings.listenFullScaleMps2, fullScale) != fullScale;
        });
    });
}

haptoflow_status haptoflow_voice_exposure(haptoflow_voice voice, haptoflow_exposure* exposure) {
    return guarded([&] {
        const VoiceTable::Use use = requireVoice(voice);
        const engine::VoiceChannels& channels = use->voice->channels;
        haptoflow_exposure content{};
        content.reason = static_cast<haptoflow_exposure_reason>(channels.exposureReason.load());
        content.gain = channels.exposureGain;
        content.short_term_mps2 = channels.exposureShortTermMps2;
        content.daily_mps2 = channels.exposureDailyMps2;
        content.lowered_seconds = channels.exposureLoweredSeconds;
        writeDescriptor(exposure, content, "exposure");
    });
}

haptoflow_status haptoflow_voice_effect_statistics(haptoflow_voice voice, haptoflow_effect effect,
                                                   haptoflow_effect_statistics* statistics) {
    return guarded([&] {
        if (effect < 0 || effect >= HAPTOFLOW_EFFECT_COUNT) {
            throw std::invalid_argument("effect is " + std::to_string(effect) + "; expected 0 to 8");
        }
        const VoiceTable::Use use = requireVoice(voice);
        const engine::VoiceCounters& counters = use->voice->channels.counters;
        const engine::EffectCounters& own = counters.effects[static_cast<std::size_t>(effect)];
        haptoflow_effect_statistics content{};
        content.is_asked_for = ((counters.requestedEffects | effectsRequestedBySettings(use->voice->channels)) >>
                                static_cast<unsigned>(effect)) &
                               1U;
        content.prepared = own.prepared;
        content.runs = own.runs;
        content.samples = own.samples;
        content.microseconds = static_cast<double>(own.nanoseconds) * 1e-3;
        content.events = own.events;
        if (effect == HAPTOFLOW_EFFECT_TEXTURE) {
            content.prepared = counters.onsets + counters.resumptions;
            content.runs = counters.inferences;
            content.samples = content.runs * inference::segmentSamples;
            content.microseconds = static_cast<double>(counters.inferenceNanoseconds) * 1e-3;
        }
        writeDescriptor(statistics, content, "statistics");
    });
}

haptoflow_status haptoflow_voice_place(haptoflow_voice voice, uint32_t* place) {
    return guarded([&] {
        (void)require(place, "place");
        const std::size_t found = voices().placeOf(voice);
        if (found == VoiceTable::capacity) {
            throw std::invalid_argument("not an open voice");
        }
        *place = static_cast<uint32_t>(found);
    });
}
