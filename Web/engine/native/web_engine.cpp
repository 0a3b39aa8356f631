#include "web_engine.hpp"

#include "capi/handles.hpp"
#include "web_imports.hpp"
#include "web_text.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

using nlohmann::json;
using namespace haptoflow;
using namespace haptoflow::web;

namespace {

// One of each in a module's memory: page, worker and audio thread share them.
haptoflow_runtime* openRuntime = nullptr;
haptoflow_model* openModel = nullptr;
haptoflow_engine* openEngine = nullptr;
std::array<haptoflow_voice, HAPTOFLOW_MAXIMUM_VOICES> openVoices{};
// For the audio thread, which also renders the fade of a voice that is no longer open.
std::array<haptoflow_voice, HAPTOFLOW_MAXIMUM_VOICES> heardVoices{};
// The newest voice's. Places are given in turn, so that a fading voice keeps its own.
std::size_t newestPlace = 0;

template <typename Struct>
Struct sized() {
    Struct content{};
    content.struct_size = sizeof(Struct);
    return content;
}

engine::LiveEngine& live() {
    return *capi::engines().get(theEngine())->engine;
}

haptoflow_voice voiceAt(int index) {
    if (index < 0 || static_cast<std::size_t>(index) >= openVoices.size() ||
        openVoices[static_cast<std::size_t>(index)] == 0) {
        throw WebError("closed", "the voice is closed");
    }
    return openVoices[static_cast<std::size_t>(index)];
}

json labelJson(const haptoflow_label_info& info, std::size_t index, bool isAdded) {
    return {{"name", info.name},
            {"category", info.category},
            {"index", index},
            {"isAdded", isAdded},
            {"isPeriodic", info.is_periodic != 0},
            {"wavelengthMetres", info.wavelength_metres},
            {"stiffnessNewtonsPerMetre", info.stiffness_newtons_per_metre},
            {"frictionCoefficient", info.friction_coefficient}};
}

json labelsJson() {
    uint32_t count = 0;
    require(haptoflow_model_label_count(theModel(), &count));
    json labels = json::array();
    for (uint32_t index = 0; index < count; ++index) {
        auto info = sized<haptoflow_label_info>();
        require(haptoflow_model_label(theModel(), index, &info));
        labels.push_back(labelJson(info, labels.size(), false));
    }
    uint32_t added = 0;
    if (openEngine != nullptr) {
        require(haptoflow_engine_material_count(openEngine, &added));
    }
    for (uint32_t index = 0; index < added; ++index) {
        auto info = sized<haptoflow_label_info>();
        require(haptoflow_engine_material(openEngine, count + index, &info));
        labels.push_back(labelJson(info, labels.size(), true));
    }
    return labels;
}

json tiersJson() {
    uint32_t count = 0;
    require(haptoflow_model_tier_count(theModel(), &count));
    json tiers = json::array();
    for (uint32_t index = 0; index < count; ++index) {
        auto info = sized<haptoflow_tier_info>();
        require(haptoflow_model_tier(theModel(), index, &info));
        tiers.push_back({{"name", info.name},
                         {"kind", info.kind},
                         {"isDefault", info.is_default != 0},
                         {"steps", info.steps},
                         {"parameterCount", info.parameter_count},
                         {"accuracy", json::parse(info.accuracy_json)},
                         {"cost", json::parse(info.cost_json)}});
    }
    return tiers;
}

json effectJson(haptoflow_voice voice, haptoflow_effect effect) {
    auto found = sized<haptoflow_effect_statistics>();
    require(haptoflow_voice_effect_statistics(voice, effect, &found));
    return {{"isAskedFor", found.is_asked_for != 0},
            {"runs", found.runs},
            {"microseconds", found.microseconds},
            {"events", found.events}};
}

/// The fields of a state in the order in which voice.mjs writes them.
haptoflow_contact_state stateFrom(const double* field) {
    auto state = sized<haptoflow_contact_state>();
    const auto nextNumber = [&field] { return *field++; };
    const auto nextFloat = [&] { return static_cast<float>(nextNumber()); };
    const auto nextCount = [&] {
        constexpr double all = 4294967296.0;
        const double number = nextNumber();
        return number >= 0.0 && number < all ? static_cast<uint32_t>(number) : 0U;
    };
    state.touching = nextCount() != 0 ? 1 : 0;
    state.touch_counter = nextCount();
    state.label_count = std::min<uint32_t>(nextCount(), HAPTOFLOW_MAXIMUM_BLEND);
    for (uint32_t& label : state.labels) {
        label = nextCount();
    }
    std::generate(std::begin(state.weights), std::end(state.weights), nextFloat);
    std::generate(std::begin(state.velocity_mps), std::end(state.velocity_mps), nextFloat);
    state.force_newtons = nextFloat();
    state.approach_speed_mps = nextFloat();
    state.effects = nextCount();
    state.edge_counter = nextCount();
    state.edge_height_metres = nextFloat();
    state.landing_counter = nextCount();
    state.spatial_scale = nextFloat();
    state.tone_db_per_octave = nextFloat();
    state.has_place = nextCount();
    state.surface_seed = nextCount();
    std::generate(std::begin(state.place_metres), std::end(state.place_metres), nextFloat);
    std::generate(std::begin(state.first_axis), std::end(state.first_axis), nextFloat);
    std::generate(std::begin(state.second_axis), std::end(state.second_axis), nextFloat);
    state.variation = nextFloat();
    state.relief = nextCount();
    std::generate(std::begin(state.relief_place), std::end(state.relief_place), nextFloat);
    state.relief_share = nextFloat();
    return state;
}

}  // namespace

namespace haptoflow::web {

haptoflow_model* theModel() {
    if (openModel == nullptr) {
        throw WebError("closed", "no model is open");
    }
    return openModel;
}

haptoflow_engine* theEngine() {
    if (openEngine == nullptr) {
        throw WebError("closed", "the engine is closed");
    }
    return openEngine;
}

haptoflow_runtime* theRuntime() {
    if (openRuntime == nullptr) {
        auto options = sized<haptoflow_runtime_options>();
        options.library_path = "onnxruntime-web";
        require(haptoflow_runtime_open(&options, &openRuntime));
    }
    return openRuntime;
}

}  // namespace haptoflow::web

HAPTO_EXPORT HAPTO_NAMED("hapto_model_open") int hapto_model_open(const void* bytes, std::uint32_t count) {
    return guarded([&] {
        auto options = sized<haptoflow_model_options>();
        options.bytes = bytes;
        options.byte_count = count;
        haptoflow_model* opened = nullptr;
        require(haptoflow_model_open(&options, &opened));
        (void)haptoflow_model_close(&openModel);
        openModel = opened;
        return 0;
    });
}

/// ModelInfo of haptoflow.d.ts.
HAPTO_EXPORT HAPTO_NAMED("hapto_model_json") const char* hapto_model_json() {
    return guardedText([] {
        auto info = sized<haptoflow_model_info>();
        require(haptoflow_model_describe(theModel(), &info));
        return dumped({{"name", info.name},
                       {"description", info.description},
                       {"statement", info.statement},
                       {"recordings", info.recordings},
                       {"licence", info.licence},
                       {"speedMps", info.speed_mps},
                       {"forceNewtons", info.force_newtons},
                       {"labels", labelsJson()},
                       {"tiers", tiersJson()}});
    });
}

HAPTO_EXPORT HAPTO_NAMED("hapto_labels_json") const char* hapto_labels_json() {
    return guardedText([] { return dumped(labelsJson()); });
}

HAPTO_EXPORT HAPTO_NAMED("hapto_engine_create") int hapto_engine_create(int quality, double updateRateHz,
                                                                        double fullScaleMps2, double seed,
                                                                        double leadMs) {
    return guarded([&] {
        auto options = sized<haptoflow_engine_options>();
        options.quality = quality;
        options.runtime = theRuntime();
        options.model = theModel();
        options.update_rate_hz = updateRateHz;
        options.full_scale_mps2 = fullScaleMps2;
        options.seed = static_cast<uint64_t>(seed);
        options.fixed_lead_ms = leadMs;
        require(haptoflow_engine_create(&options, &openEngine));
        return 0;
    });
}

HAPTO_EXPORT HAPTO_NAMED("hapto_engine_set_quality") int hapto_engine_set_quality(int quality) {
    return guarded([&] {
        require(haptoflow_engine_set_quality(theEngine(), quality));
        return 0;
    });
}

/// The worker's loop: waits until there is work, at most this time, and does it. 0 after the worker has ended.
HAPTO_EXPORT HAPTO_NAMED("hapto_engine_turn") int hapto_engine_turn(double maximumWaitMs) {
    return guarded([&] { return live().turn(maximumWaitMs) ? 1 : 0; });
}

/// Ends the worker's wait.
HAPTO_EXPORT HAPTO_NAMED("hapto_engine_wake") int hapto_engine_wake() {
    return guarded([] {
        live().wake();
        return 0;
    });
}

HAPTO_EXPORT HAPTO_NAMED("hapto_engine_close") int hapto_engine_close() {
    return guarded([] {
        openVoices.fill(0);
        require(haptoflow_engine_close(&openEngine));
        return 0;
    });
}

HAPTO_EXPORT HAPTO_NAMED("hapto_engine_statistics") const char* hapto_engine_statistics() {
    return guardedText([] {
        auto found = sized<haptoflow_engine_statistics>();
        require(haptoflow_engine_get_statistics(theEngine(), &found));
        std::array<char, 1024> failureText{};
        uint64_t length = 0;
        require(haptoflow_engine_last_failure(theEngine(), failureText.data(), failureText.size(), &length));
        json tiers = json::array();
        uint32_t count = 0;
        require(haptoflow_model_tier_count(theModel(), &count));
        for (uint32_t index = 0; index < count; ++index) {
            auto info = sized<haptoflow_tier_info>();
            require(haptoflow_model_tier(theModel(), index, &info));
            auto times = sized<haptoflow_tier_times>();
            require(haptoflow_engine_tier_times(theEngine(), index, &times));
            tiers.push_back({{"name", info.name},
                             {"isCurrent", times.is_current != 0},
                             {"runs", times.runs},
                             {"medianMs", times.median_ms},
                             {"percentile99Ms", times.percentile_99_ms}});
        }
        return dumped({{"tier", tiers.at(found.tier).at("name")},
                       {"isMeasuring", found.is_measuring != 0},
                       {"rounds", found.rounds},
                       {"segments", found.segments},
                       {"failedRounds", found.failed_rounds},
                       {"budgetMs", found.budget_ms},
                       {"lastRoundMs", found.last_round_ms},
                       {"qualityStepsDown", found.quality_steps_down},
                       {"qualityStepsUp", found.quality_steps_up},
                       {"workerIsAlive", found.worker_is_alive != 0},
                       {"lastFailure", failureText.data()},
                       {"tiers", tiers}});
    });
}

/// Registers a material, or replaces the added one at `replaced` (-1 for none). Returns its index.
HAPTO_EXPORT HAPTO_NAMED("hapto_material_add") int hapto_material_add(const char* text, std::uint32_t length,
                                                                      int replaced) {
    return guarded([&] {
        auto index = static_cast<uint32_t>(std::max(replaced, 0));
        require(replaced >= 0 ? haptoflow_engine_replace_material(theEngine(), index, text, length)
                              : haptoflow_engine_register_material(theEngine(), text, length, &index));
        return static_cast<int>(index);
    });
}

/// Returns the relief's number in this memory, above 0. The heights are copied.
HAPTO_EXPORT HAPTO_NAMED("hapto_relief_create") int hapto_relief_create(const float* heightsMetres,
                                                                        std::uint32_t columns, std::uint32_t rows,
                                                                        int isTiled, float alongMetres,
                                                                        float acrossMetres, float depthMetres,
                                                                        float tipRadiusMetres) {
    return guarded([&] {
        auto options = sized<haptoflow_relief_options>();
        options.columns = columns;
        options.rows = rows;
        options.is_tiled = isTiled != 0 ? 1 : 0;
        options.heights_metres = heightsMetres;
        options.size_metres[0] = alongMetres;
        options.size_metres[1] = acrossMetres;
        options.depth_metres = depthMetres;
        options.tip_radius_metres = tipRadiusMetres;
        haptoflow_relief relief = 0;
        require(haptoflow_relief_create(&options, &relief));
        return static_cast<int>(relief);
    });
}

/// Writes the heights of a normal map, as many as texels; `normals` are three numbers for each.
HAPTO_EXPORT HAPTO_NAMED("hapto_relief_heights_of_normals") int hapto_relief_heights_of_normals(
    const float* normals, std::uint32_t columns, std::uint32_t rows, int isTiled, float alongMetres, float acrossMetres,
    float* heightsMetres) {
    return guarded([&] {
        const float sizeMetres[] = {alongMetres, acrossMetres};
        require(haptoflow_relief_heights_of_normals(normals, columns, rows, sizeMetres, isTiled != 0 ? 1 : 0,
                                                    heightsMetres));
        return 0;
    });
}

HAPTO_EXPORT HAPTO_NAMED("hapto_relief_destroy") int hapto_relief_destroy(int number) {
    return guarded([&] {
        auto relief = static_cast<haptoflow_relief>(number);
        require(haptoflow_relief_destroy(&relief));
        return 0;
    });
}

HAPTO_EXPORT HAPTO_NAMED("hapto_voice_create") int hapto_voice_create(double rateHz) {
    return guarded([&] {
        std::size_t place = newestPlace;
        do {
            place = (place + 1) % openVoices.size();
            if (openVoices[place] == 0) {
                haptoflow_voice voice = 0;
                require(haptoflow_voice_create(theEngine(), rateHz, &voice));
                openVoices[place] = voice;
                heardVoices[place] = voice;
                newestPlace = place;
                return static_cast<int>(place);
            }
        } while (place != newestPlace);
        throw WebError("invalid-argument", "all voices are in use: close one first");
    });
}

HAPTO_EXPORT HAPTO_NAMED("hapto_voice_destroy") int hapto_voice_destroy(int index) {
    return guarded([&] {
        haptoflow_voice voice = voiceAt(index);
        openVoices[static_cast<std::size_t>(index)] = 0;
        require(haptoflow_voice_destroy(&voice));
        return 0;
    });
}

HAPTO_EXPORT HAPTO_NAMED("hapto_voice_publish") int hapto_voice_publish(int index, const double* fields) {
    return guarded([&] {
        const haptoflow_contact_state state = stateFrom(fields);
        require(haptoflow_voice_publish(voiceAt(index), &state));
        return 0;
    });
}

/// On the audio thread: no exception is thrown, nothing allocates.
HAPTO_EXPORT HAPTO_NAMED("hapto_voice_render") int hapto_voice_render(int index, float* samples, std::uint32_t frames,
                                                                      double rateHz) {
    const bool isKnown = index >= 0 && static_cast<std::size_t>(index) < heardVoices.size();
    return haptoflow_voice_render(isKnown ? heardVoices[static_cast<std::size_t>(index)] : 0, samples, frames, 1, 0,
                                  rateHz);
}

/// Sets what `name` says: see the list. Times in seconds.
HAPTO_EXPORT HAPTO_NAMED("hapto_voice_set") int hapto_voice_set(int index, const char* name, double value) {
    return guarded([&] {
        const haptoflow_voice voice = voiceAt(index);
        const std::string_view what(name);
        const auto number = static_cast<float>(value);
        const uint32_t isOn = value != 0.0 ? 1 : 0;
        if (what == "gain") {
            require(haptoflow_voice_set_strength(voice, number));
        } else if (what == "ceiling") {
            require(haptoflow_voice_set_ceiling(voice, number));
        } else if (what == "muted") {
            require(haptoflow_voice_set_muted(voice, isOn));
        } else if (what == "paused") {
            require(haptoflow_voice_set_paused(voice, isOn));
        } else if (what == "listen") {
            require(haptoflow_voice_set_listen(voice, isOn));
        } else if (what == "delay") {
            require(haptoflow_voice_set_delay(voice, value));
        } else if (what == "panic") {
            require(haptoflow_voice_panic(voice));
        } else {
            throw std::invalid_argument("a voice has no \"" + std::string(what) + '"');
        }
        return 0;
    });
}

/// A null profile takes the compensation away.
HAPTO_EXPORT HAPTO_NAMED("hapto_voice_set_actuator") int hapto_voice_set_actuator(int index, const char* profile,
                                                                                  std::uint32_t length) {
    return guarded([&] {
        require(haptoflow_voice_set_actuator(voiceAt(index), profile, length));
        return 0;
    });
}

/// Plays a clip of this memory, or ends the one that plays, for 0.
HAPTO_EXPORT HAPTO_NAMED("hapto_voice_play_clip") int hapto_voice_play_clip(int index, int clip, double gain,
                                                                            int isLoop) {
    return guarded([&] {
        const auto* address = reinterpret_cast<const haptoflow_clip*>(static_cast<std::uintptr_t>(clip));
        require(haptoflow_voice_play_clip(voiceAt(index), address, static_cast<float>(gain), isLoop != 0 ? 1 : 0));
        return 0;
    });
}

/// The haptoflow_silence of the newest block.
HAPTO_EXPORT HAPTO_NAMED("hapto_voice_silence") int hapto_voice_silence(int index) {
    return guarded([&] {
        auto found = sized<haptoflow_voice_statistics>();
        require(haptoflow_voice_get_statistics(voiceAt(index), &found));
        return static_cast<int>(found.silence);
    });
}

HAPTO_EXPORT HAPTO_NAMED("hapto_voice_statistics") const char* hapto_voice_statistics(int index) {
    return guardedText([&] {
        const haptoflow_voice voice = voiceAt(index);
        auto found = sized<haptoflow_voice_statistics>();
        require(haptoflow_voice_get_statistics(voice, &found));
        constexpr double samplesPerMs = 2.0;
        return dumped({{"silence", found.silence},
                       {"leadMs", found.lead_samples / samplesPerMs},
                       {"updates", found.updates},
                       {"inferences", found.inferences},
                       {"inferenceMs", found.inference_ms},
                       {"onsets", found.onsets},
                       {"taps", found.taps},
                       {"underruns", found.underruns},
                       {"sketched", found.sketched},
                       {"late", found.late},
                       {"dropped", found.dropped},
                       {"failures", found.failures},
                       {"sanitised", found.sanitised},
                       {"staleStops", found.stale_stops},
                       {"nonFiniteSamples", found.non_finite_samples},
                       {"limitedSamples", found.limited_samples},
                       {"renderedFrames", found.rendered_frames},
                       {"resumptions", found.resumptions},
                       {"effects",
                        {{"texture", effectJson(voice, HAPTOFLOW_EFFECT_TEXTURE)},
                         {"impact", effectJson(voice, HAPTOFLOW_EFFECT_IMPACT)},
                         {"edge", effectJson(voice, HAPTOFLOW_EFFECT_EDGE)},
                         {"relief", effectJson(voice, HAPTOFLOW_EFFECT_RELIEF)},
                         {"clip", effectJson(voice, HAPTOFLOW_EFFECT_CLIP)},
                         {"delay", effectJson(voice, HAPTOFLOW_EFFECT_DELAY)},
                         {"compensation", effectJson(voice, HAPTOFLOW_EFFECT_COMPENSATION)},
                         {"listen", effectJson(voice, HAPTOFLOW_EFFECT_LISTEN)}}}});
    });
}
