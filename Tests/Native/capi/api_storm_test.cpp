// Random sequences of calls, valid and invalid ones, from several threads at once. Under the sanitizers they prove that
// there is no crash, race or leak; here, that every status is known and every sample finite.
#include "open_engine.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <deque>
#include <functional>
#include <limits>
#include <mutex>
#include <random>
#include <string>
#include <thread>
#include <type_traits>
#include <vector>

namespace haptoflow::capi::testing {
namespace {

/// Handles of one kind that threads share, both open and closed ones.
template <typename Handle>
class SharedHandles {
public:
    void put(Handle handle) {
        const std::lock_guard lock(mutex_);
        handles_.push_back(handle);
    }
    /// Mostly one of the newest handles, many of which are open; otherwise an older one, null, or an invalid one.
    Handle any(std::uint32_t choice) {
        const std::lock_guard lock(mutex_);
        if (handles_.empty() || choice % 11 == 0) {
            return Handle{};
        }
        if (choice % 13 == 0) {
            // Odd, unlike every handle of a table.
            const std::uint32_t invented = choice | 1U;
            if constexpr (std::is_pointer_v<Handle>) {
                // NOLINTNEXTLINE(performance-no-int-to-ptr): refused, never dereferenced.
                return reinterpret_cast<Handle>(std::uintptr_t{invented});
            } else {
                return invented;
            }
        }
        const std::size_t newest = std::min<std::size_t>(handles_.size(), 6);
        const std::size_t eligible = choice % 8 == 0 ? handles_.size() : newest;
        return handles_[handles_.size() - 1 - choice / 8 % eligible];
    }
    std::vector<Handle> all() {
        const std::lock_guard lock(mutex_);
        return handles_;
    }

private:
    std::mutex mutex_;
    std::vector<Handle> handles_;
};

struct StormHandles {
    SharedHandles<haptoflow_runtime*> runtimes;
    SharedHandles<haptoflow_model*> models;
    SharedHandles<haptoflow_generator*> generators;
    SharedHandles<haptoflow_cancellation*> cancellations;
    SharedHandles<haptoflow_engine*> engines;
    SharedHandles<haptoflow_voice> voices;
    SharedHandles<haptoflow_relief> reliefs;
    SharedHandles<haptoflow_clip*> clips;
};

class Storm {
public:
    Storm(StormHandles& handles, const std::string& modelBytes, std::uint32_t seed)
        : handles_(handles), modelBytes_(modelBytes), random_(seed) {}

    /// Makes at least `calls` calls and continues until a block of this thread has sounded, because on a busy machine
    /// the other threads may close its objects too early. 20 times as many calls are enough for every schedule.
    void run(int calls) {
        for (int call = 0; call < calls || (!hasSounded_ && call < 20 * calls); ++call) {
            check(once());
        }
    }
    [[nodiscard]] bool isSound() const { return isSound_; }
    [[nodiscard]] bool hasSounded() const { return hasSounded_; }

private:
    /// A kind of call and its share of all calls in thousandths.
    struct Kind {
        std::uint32_t share;
        std::function<haptoflow_status()> call;
    };

    std::vector<Kind> makeKinds() {
        return {
            {430, [this] { return render(); }},
            {304, [this] { return publish(); }},
            {30, [this] { return createVoice(); }},
            {15, [this] { return closed(handles_.voices, haptoflow_voice_destroy); }},
            {8, [this] { return createEngine(); }},
            {2, [this] { return closed(handles_.engines, haptoflow_engine_close); }},
            {6, [this] { return openModel(); }},
            {2, [this] { return closed(handles_.models, haptoflow_model_close); }},
            {4, [this] { return openRuntime(); }},
            {1, [this] { return closed(handles_.runtimes, haptoflow_runtime_close); }},
            {8, [this] { return createGenerator(); }},
            {2, [this] { return closed(handles_.generators, haptoflow_generator_close); }},
            {11, [this] { return generate(); }},
            {6, [this] { return haptoflow_generator_set_solver(generator(), solver(), steps()); }},
            {6, [this] { return opened(handles_.cancellations, haptoflow_cancellation_create); }},
            {2, [this] { return haptoflow_cancellation_cancel(handles_.cancellations.any(next())); }},
            {2, [this] { return closed(handles_.cancellations, haptoflow_cancellation_close); }},
            {12, [this] { return createRelief(); }},
            {8, [this] { return closed(handles_.reliefs, haptoflow_relief_destroy); }},
            {6, [this] { return createClip(); }},
            {6, [this] { return readClip(); }},
            {8, [this] { return closed(handles_.clips, haptoflow_clip_close); }},
            {16, [this] { return playClip(); }},
            {3, [this] { return haptoflow_model_header(model(), result<const char*>()); }},
            {3, [this] { return haptoflow_model_label_count(model(), result<uint32_t>()); }},
            {4, [this] { return haptoflow_model_label(model(), index(), result<haptoflow_label_info>()); }},
            {4, [this] { return haptoflow_model_embedding(model(), index(), orNull(embedding_.data())); }},
            {3, [this] { return haptoflow_model_tier_count(model(), result<uint32_t>()); }},
            {3, [this] { return haptoflow_model_tier(model(), index(), result<haptoflow_tier_info>()); }},
            {6, [this] { return useMaterial(); }},
            {3, [this] { return haptoflow_engine_material_count(engine(), result<uint32_t>()); }},
            {3, [this] { return haptoflow_engine_material(engine(), index(), result<haptoflow_label_info>()); }},
            {5, [this] { return haptoflow_voice_set_strength(voice(), wildFloat()); }},
            {5, [this] { return haptoflow_voice_set_ceiling(voice(), wildFloat()); }},
            {5, [this] { return haptoflow_voice_set_muted(voice(), next() % 2); }},
            {5, [this] { return haptoflow_voice_set_paused(voice(), next() % 2); }},
            {5, [this] { return haptoflow_voice_panic(voice()); }},
            {5, [] { return haptoflow_panic(); }},
            {5, [this] { return haptoflow_voice_get_statistics(voice(), result<haptoflow_voice_statistics>()); }},
            {4, [this] { return haptoflow_voice_set_signal(voice(), 1000.0 * wildFloat(), 100.0 * wildFloat()); }},
            {4, [this] { return haptoflow_voice_signal_statistics(voice(), result<haptoflow_signal_statistics>()); }},
            {4, [this] { return place(); }},
            {4, [this] { return haptoflow_engine_set_quality(engine(), quality()); }},
            {5, [this] { return haptoflow_engine_step(engine()); }},
            {5, [this] { return haptoflow_engine_get_statistics(engine(), result<haptoflow_engine_statistics>()); }},
            {4, [this] { return haptoflow_engine_tier_times(engine(), index(), result<haptoflow_tier_times>()); }},
            {4, [this] { return haptoflow_struct_size("haptoflow_batch", result<uint32_t>()); }},
            {4, [this] { return readTexts(); }},
        };
    }

    haptoflow_status once() {
        std::uint32_t choice = next() % 1000;
        for (const Kind& kind : kinds_) {
            if (choice < kind.share) {
                return kind.call();
            }
            choice -= kind.share;
        }
        return HAPTOFLOW_INTERNAL_ERROR;
    }

    haptoflow_voice voice() { return handles_.voices.any(next()); }
    haptoflow_engine* engine() { return handles_.engines.any(next()); }
    haptoflow_model* model() { return handles_.models.any(next()); }
    haptoflow_generator* generator() { return handles_.generators.any(next()); }
    haptoflow_quality quality() { return static_cast<haptoflow_quality>(next() % 5); }
    haptoflow_solver solver() { return static_cast<haptoflow_solver>(next() % 5); }
    std::int32_t steps() { return static_cast<std::int32_t>(next() % 20) - 1; }
    std::uint32_t index() { return oneIn(8) ? next() : next() % 8; }

    /// Where a call may write what it returns; sometimes nowhere, or with a wrong size.
    template <typename Result>
    Result* result() {
        thread_local Result written;
        if constexpr (requires { written.struct_size; }) {
            written.struct_size = sizeOf(sizeof(Result));
        }
        return orNull(&written);
    }
    template <typename Type>
    Type* orNull(Type* pointer) {
        return oneIn(16) ? nullptr : pointer;
    }

    /// Calls open(Handle*) and keeps what it opens.
    template <typename Handle, typename Open>
    haptoflow_status opened(SharedHandles<Handle>& pool, Open open) {
        Handle handle{};
        const haptoflow_status status = open(orNull(&handle));
        if (status == HAPTOFLOW_OK) {
            pool.put(handle);
        }
        return status;
    }
    template <typename Handle>
    haptoflow_status closed(SharedHandles<Handle>& pool, haptoflow_status (*close)(Handle*)) {
        Handle handle = pool.any(next());
        return close(orNull(&handle));
    }

    std::uint32_t next() { return static_cast<std::uint32_t>(random_()); }
    bool oneIn(std::uint32_t count) { return next() % count == 0; }

    float wildFloat() {
        switch (next() % 8) {
            case 0:
                return std::numeric_limits<float>::quiet_NaN();
            case 1:
                return -std::numeric_limits<float>::infinity();
            case 2:
                return std::numeric_limits<float>::max();
            case 3:
                return std::numeric_limits<float>::denorm_min();
            case 4:
                return 0.0F;
            default:
                return static_cast<float>(next() % 2000) / 1000.0F;
        }
    }

    std::vector<float> wildFloats(std::size_t count) {
        std::vector<float> values(count);
        const bool isWild = oneIn(4);
        for (float& value : values) {
            value = isWild ? wildFloat() : static_cast<float>(next() % 2000) / 1000.0F;
        }
        return values;
    }

    double rateHz() {
        constexpr std::array<double, 8> rare{44100.0,
                                             24000.0,
                                             0.0,
                                             -1.0,
                                             1.0,
                                             1e300,
                                             std::numeric_limits<double>::quiet_NaN(),
                                             std::numeric_limits<double>::infinity()};
        return oneIn(4) ? rare[next() % rare.size()] : 48000.0;
    }

    uint32_t sizeOf(std::size_t structSize) { return oneIn(32) ? next() % 80 : static_cast<uint32_t>(structSize); }

    haptoflow_contact_state wildState() {
        haptoflow_contact_state state = slidingState();
        state.touching = next() % 4;
        state.touch_counter = next() % 5;
        state.label_count = oneIn(16) ? next() : next() % 5;
        for (std::size_t i = 0; i < HAPTOFLOW_MAXIMUM_BLEND; ++i) {
            state.labels[i] = oneIn(8) ? next() : next() % 4;
            state.weights[i] = wildFloat();
        }
        state.velocity_mps[0] = wildFloat();
        state.velocity_mps[1] = wildFloat();
        state.force_newtons = wildFloat();
        state.spatial_scale = wildFloat();
        state.tone_db_per_octave = wildFloat();
        state.variation = wildFloat();
        state.effects = oneIn(4) ? next() : HAPTOFLOW_ASKS_FOR_TEXTURE | HAPTOFLOW_ASKS_FOR_RELIEF;
        state.relief = handles_.reliefs.any(next());
        std::ranges::generate(state.relief_place, [this] { return wildFloat(); });
        state.relief_share = wildFloat();
        state.has_place = next() % 3;
        state.surface_seed = next() % 4;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            state.place_metres[axis] = wildFloat();
            // Usable axes in most states, so that wild places reach the noise.
            state.first_axis[axis] = oneIn(16) ? wildFloat() : (axis == 0 ? 1.0F : 0.0F);
            state.second_axis[axis] = oneIn(16) ? wildFloat() : (axis == 1 ? 1.0F : 0.0F);
        }
        state.struct_size = sizeOf(sizeof(state));
        return state;
    }

    haptoflow_status render() {
        const std::uint32_t frames = next() % 600;
        const std::uint32_t channels = oneIn(16) ? next() % 70 : 1 + next() % 4;
        const std::int32_t channel = static_cast<std::int32_t>(next() % (channels + 3)) - 2;
        std::vector<float> block(std::size_t{frames} * channels + 1);
        float* const samples = orNull(block.data());
        std::array<haptoflow_voice, 3> voices{};
        std::ranges::generate(voices, [this] { return voice(); });
        const haptoflow_status status =
            oneIn(2) ? haptoflow_voice_render(voices[0], samples, frames, channels, channel, rateHz())
                     : haptoflow_voices_render(voices.data(), next() % 4, samples, frames, channels, channel, rateHz());
        isSound_ = isSound_ && allFinite(block) && peak(block) <= 1.0F;
        hasSounded_ = hasSounded_ || peak(block) > 0.0F;
        return status;
    }

    haptoflow_status publish() {
        const haptoflow_contact_state state = wildState();
        return haptoflow_voice_publish(voice(), orNull(&state));
    }

    haptoflow_status createVoice() {
        return opened(handles_.voices,
                      [this](auto* created) { return haptoflow_voice_create(engine(), rateHz(), created); });
    }

    haptoflow_status place() {
        std::uint32_t place = 0;
        const haptoflow_status status = haptoflow_voice_place(voice(), orNull(&place));
        isSound_ = isSound_ && place < HAPTOFLOW_MAXIMUM_VOICES;
        return status;
    }

    haptoflow_status readTexts() {
        isSound_ = isSound_ && haptoflow_last_message() != nullptr &&
                   haptoflow_status_name(static_cast<haptoflow_status>(next())) != nullptr;
        return HAPTOFLOW_OK;
    }

    haptoflow_status createRelief() {
        std::vector<float> heights = wildFloats(std::size_t{40} * 3);
        haptoflow_relief_options options{};
        options.struct_size = sizeOf(sizeof(options));
        options.columns = oneIn(16) ? next() : 1 + next() % 40;
        options.rows = oneIn(16) ? next() : 1 + next() % 3;
        // Counts beyond what is there are refused only by their size.
        if (std::size_t{options.columns} * options.rows > heights.size()) {
            options.columns = options.rows = UINT32_MAX;
        }
        options.is_tiled = next() % 2;
        options.heights_metres = orNull(heights.data());
        options.size_metres[0] = wildFloat();
        options.size_metres[1] = 0.1F;
        options.depth_metres = wildFloat();
        options.tip_radius_metres = oneIn(4) ? wildFloat() : 0.0005F;
        return opened(handles_.reliefs, [&options](auto* relief) { return haptoflow_relief_create(&options, relief); });
    }

    haptoflow_status createClip() {
        const std::vector<float> wave = wildFloats(500);
        haptoflow_clip_options options{};
        options.struct_size = sizeOf(sizeof(options));
        options.wave_mps2 = orNull(wave.data());
        options.sample_count = next() % wave.size();
        options.is_loop = next() % 2;
        return opened(handles_.clips, [&options](auto* clip) { return haptoflow_clip_create(&options, clip); });
    }

    /// Reads a clip's text that may be cut.
    haptoflow_status readClip() {
        static const std::string text =
            R"({"version":{"major":1,"minor":0,"patch":0},"signals":{"continuous":{"envelopes":{"amplitude":[)"
            R"({"time":0,"amplitude":0.5,"emphasis":{"amplitude":1,"frequency":0.5}},{"time":0.3,"amplitude":0.5}]}}}})";
        const std::size_t length = oneIn(8) ? next() % text.size() : text.size();
        return opened(handles_.clips, [&](auto* clip) { return haptoflow_clip_read(text.data(), length, clip); });
    }

    haptoflow_status playClip() {
        haptoflow_clip* clip = oneIn(4) ? nullptr : handles_.clips.any(next());
        return haptoflow_voice_play_clip(voice(), clip, wildFloat(), next() % 2);
    }

    haptoflow_status createEngine() {
        haptoflow_engine_options options{};
        options.struct_size = sizeOf(sizeof(options));
        options.quality = quality();
        options.runtime = handles_.runtimes.any(next());
        options.model = model();
        options.without_worker = oneIn(3) ? 1 : 0;
        options.update_rate_hz = oneIn(8) ? rateHz() : 0.0;
        options.cancellation = oneIn(3) ? handles_.cancellations.any(next()) : nullptr;
        return opened(handles_.engines, [&options](auto* engine) { return haptoflow_engine_create(&options, engine); });
    }

    /// Opens the whole file, a part of it, or the file with a changed byte.
    haptoflow_status openModel() {
        std::string bytes = modelBytes_;
        if (oneIn(4)) {
            bytes[next() % bytes.size()] ^= 1;
        }
        if (oneIn(4)) {
            bytes.resize(next() % bytes.size());
        }
        haptoflow_model_options options{};
        options.struct_size = sizeOf(sizeof(options));
        options.bytes = orNull(bytes.data());
        options.byte_count = bytes.size();
        const haptoflow_status status =
            opened(handles_.models, [&options](auto* model) { return haptoflow_model_open(&options, model); });
        const bool isRefusal = status >= HAPTOFLOW_NOT_A_MODEL && status <= HAPTOFLOW_MODEL_INCONSISTENT;
        return isRefusal ? HAPTOFLOW_OK : status;
    }

    haptoflow_status openRuntime() {
        const bool isThere = !oneIn(4);
        haptoflow_runtime_options options{};
        options.struct_size = sizeOf(sizeof(options));
        options.library_path = isThere ? HAPTOFLOW_TEST_ONNXRUNTIME : "/nowhere/libonnxruntime.so";
        const haptoflow_status status =
            opened(handles_.runtimes, [&options](auto* runtime) { return haptoflow_runtime_open(&options, runtime); });
        return !isThere && status == HAPTOFLOW_RUNTIME_UNAVAILABLE ? HAPTOFLOW_OK : status;
    }

    haptoflow_status createGenerator() {
        constexpr std::array<const char*, 4> tiers{"draft", "standard", nullptr, "no such tier"};
        haptoflow_generator_options options{};
        options.struct_size = sizeOf(sizeof(options));
        options.runtime = handles_.runtimes.any(next());
        options.model = model();
        options.tier = tiers[next() % tiers.size()];
        options.maximum_batch = oneIn(8) ? next() : next() % 4;
        options.cancellation = oneIn(3) ? handles_.cancellations.any(next()) : nullptr;
        return opened(handles_.generators,
                      [&options](auto* generator) { return haptoflow_generator_create(&options, generator); });
    }

    haptoflow_status generate() {
        const std::uint32_t count = next() % 4;
        const std::vector<float> embeddings = wildFloats(std::size_t{count} * HAPTOFLOW_EMBEDDING_SIZE);
        const std::vector<float> motions = wildFloats(std::size_t{count} * HAPTOFLOW_MOTION_SIZE);
        const std::vector<float> waveforms = wildFloats(std::size_t{count} * HAPTOFLOW_SEGMENT_SAMPLES);
        const std::vector<float> phases = wildFloats(std::size_t{count} * HAPTOFLOW_PHASES);
        const std::vector<float> ownLevels = wildFloats(count);
        haptoflow_batch batch{sizeOf(sizeof(batch)),
                              count,
                              embeddings.data(),
                              motions.data(),
                              waveforms.data(),
                              waveforms.data(),
                              oneIn(2) ? phases.data() : nullptr,
                              oneIn(4) ? ownLevels.data() : nullptr,
                              nullptr};
        if (oneIn(8)) {
            batch.count = next();
            batch.motions = nullptr;
        }
        std::vector<float> results(waveforms.size());
        const haptoflow_status status = haptoflow_generator_generate(generator(), &batch, orNull(results.data()));
        isSound_ = isSound_ && (status != HAPTOFLOW_OK || allFinite(results));
        return status == HAPTOFLOW_INFERENCE_FAILED ? HAPTOFLOW_OK : status;
    }

    /// Registers a valid material of the tiny model, or a text that is cut, or replaces one by it.
    haptoflow_status useMaterial() {
        static const std::string material = textOf(HAPTOFLOW_TEST_GOLDEN_DIR "/material/ribbed.haptomaterial");
        const std::uint64_t length = oneIn(8) ? next() % material.size() : material.size();
        return oneIn(2) ? haptoflow_engine_register_material(engine(), material.data(), length, result<uint32_t>())
                        : haptoflow_engine_replace_material(engine(), index(), material.data(), length);
    }

    void check(haptoflow_status status) {
        isSound_ = isSound_ && (status == HAPTOFLOW_OK || status == HAPTOFLOW_INVALID_ARGUMENT ||
                                status == HAPTOFLOW_BUSY || status == HAPTOFLOW_CANCELLED ||
                                status == HAPTOFLOW_MATERIAL_INVALID || status == HAPTOFLOW_MATERIAL_MISMATCH);
    }

    StormHandles& handles_;
    const std::string& modelBytes_;
    std::mt19937 random_;
    std::array<float, HAPTOFLOW_EMBEDDING_SIZE> embedding_{};
    const std::vector<Kind> kinds_ = makeKinds();
    bool isSound_ = true;
    bool hasSounded_ = false;
};

class ApiStormTest : public ::testing::Test {
protected:
    /// Number of calls of each thread, from HAPTOFLOW_TEST_STORM_CALLS; the soak test sets a large one.
    static int callsOfAThread(int usual) {
        // NOLINTNEXTLINE(concurrency-mt-unsafe): before the threads begin.
        const char* given = std::getenv("HAPTOFLOW_TEST_STORM_CALLS");
        return given != nullptr ? std::atoi(given) : usual;
    }

    template <typename Type>
    static void closeAll(SharedHandles<Type*>& handles, haptoflow_status (*close)(Type**)) {
        for (Type* handle : handles.all()) {
            (void)close(&handle);
        }
    }

    static void storm(int threadCount, int calls) {
        const std::string modelBytes = textOf(tinyModelPath);
        StormHandles handles;
        handles.runtimes.put(openRuntime());
        handles.models.put(openModel(tinyModelPath));
        std::deque<Storm> storms;
        for (int i = 0; i < threadCount; ++i) {
            storms.emplace_back(handles, modelBytes, static_cast<std::uint32_t>(i + 1));
        }
        std::vector<std::thread> threads;
        threads.reserve(storms.size());
        for (Storm& each : storms) {
            threads.emplace_back([&each, calls] { each.run(calls); });
        }
        for (std::thread& thread : threads) {
            thread.join();
        }
        for (const Storm& each : storms) {
            EXPECT_TRUE(each.isSound());
            EXPECT_TRUE(each.hasSounded()) << "a storm without sound proves little";
        }
        // Objects that the storm left open are closed here; handles that it closed are refused.
        closeAll(handles.engines, haptoflow_engine_close);
        closeAll(handles.generators, haptoflow_generator_close);
        closeAll(handles.cancellations, haptoflow_cancellation_close);
        closeAll(handles.models, haptoflow_model_close);
        closeAll(handles.runtimes, haptoflow_runtime_close);
    }
};

TEST_F(ApiStormTest, EveryCallOfARandomSequenceFromOneThreadReturnsAStatus) {
    storm(1, callsOfAThread(3000));
}

TEST_F(ApiStormTest, EveryCallOfRandomSequencesFromFourThreadsReturnsAStatus) {
    storm(4, callsOfAThread(1500));
}

}  // namespace
}  // namespace haptoflow::capi::testing
