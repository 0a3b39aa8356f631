// Runs the callback under load and counts forbidden calls: in the C library by interposition, in the kernel by a system
// call filter on the thread.
#include "capi/open_engine.hpp"
#include "realtime/forbidden_calls.hpp"
#include "unity/unity_host.hpp"

#include <gtest/gtest.h>

#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstdlib>
#include <mutex>
#include <span>
#include <string>
#include <thread>

namespace haptoflow::realtime {
namespace {

using capi::testing::OpenEngine;

/// Number of callbacks, from HAPTOFLOW_TEST_CALLBACKS; the soak test sets a million.
std::uint64_t callbackCount() {
    const char* asked = std::getenv("HAPTOFLOW_TEST_CALLBACKS");
    return asked != nullptr ? std::strtoull(asked, nullptr, 10) : 12'000;
}

/// Synchronises device and hand, so that a contact state is published every 13 ms of output, independent of the
/// machine's speed.
struct Pace {
    static constexpr std::uint64_t callbacksOfAnUpdate = 8;
    std::atomic<std::uint64_t> allowedCallbacks{0};
    std::atomic<bool> done{false};
};

/// Changes a voice while it is rendered: touches, taps, panics, mutes, new labels, invalid states.
void disturb(haptoflow_voice voice, Pace& pace) {
    std::array<haptoflow_relief, 2> reliefs{};
    std::array<float, 32 * 32> heightsMetres{};
    for (std::size_t texel = 0; texel < heightsMetres.size(); ++texel) {
        heightsMetres[texel] = 1e-5F * static_cast<float>(texel * 7 % 13);
    }
    haptoflow_relief_options options{};
    options.struct_size = sizeof(options);
    options.columns = options.rows = 32;
    options.is_tiled = 1;
    options.heights_metres = heightsMetres.data();
    options.size_metres[0] = options.size_metres[1] = 0.01F;
    options.depth_metres = options.tip_radius_metres = 0.0005F;
    for (std::uint32_t update = 0; !pace.done; ++update) {
        haptoflow_contact_state state = capi::testing::slidingState();
        state.touch_counter = update / 40;
        state.touching = update % 40 < 34 ? 1 : 0;
        state.labels[0] = update % 3;
        // Tone, feature scale and blend change.
        state.tone_db_per_octave = update % 5 == 0 ? 0.0F : static_cast<float>(update % 9) - 4.0F;
        state.spatial_scale = 0.5F + static_cast<float>(update % 4);
        state.variation = 0.25F * static_cast<float>(update / 3 % 5);
        state.surface_seed = update / 7;
        state.label_count = 1 + update % 2;
        state.labels[1] = (update / 2) % 3;
        state.weights[1] = 0.5F;
        // Reliefs are exchanged and freed under the tip.
        if (update % 37 == 0) {
            (void)haptoflow_relief_destroy(&reliefs[update / 37 % 2]);
            (void)haptoflow_relief_create(&options, &reliefs[update / 37 % 2]);
        }
        state.effects = update % 19 < 12 ? HAPTOFLOW_ASKS_FOR_TEXTURE | HAPTOFLOW_ASKS_FOR_RELIEF : 0;
        state.relief = reliefs[update / 11 % 2];
        state.relief_place[0] = 0.1F * static_cast<float>(update);
        state.relief_share = 0.5F;
        state.velocity_mps[1] = update % 29 == 0 ? std::nanf("") : 0.02F * static_cast<float>(update % 17);
        state.force_newtons = update % 31 == 0 ? INFINITY : 0.5F + 0.1F * static_cast<float>(update % 7);
        (void)haptoflow_voice_publish(voice, &state);
        (void)haptoflow_voice_set_muted(voice, update % 53 == 52 ? 1 : 0);
        (void)haptoflow_voice_set_strength(voice, 0.5F + 0.5F * static_cast<float>(update % 2));
        // A signal replaces the texture for a while.
        if (update % 67 == 40 || update % 67 == 66) {
            (void)haptoflow_voice_set_signal(voice, 20.0 + update % 480, update % 67 == 40 ? 6.0 : 0.0);
        }
        (void)haptoflow_voice_set_listen(voice, update % 23 < 16 ? 1 : 0);
        if (update % 101 == 100) {
            (void)haptoflow_voice_panic(voice);
        }
        pace.allowedCallbacks += Pace::callbacksOfAnUpdate;
        std::this_thread::sleep_for(std::chrono::microseconds(700));
    }
    for (haptoflow_relief& relief : reliefs) {
        (void)haptoflow_relief_destroy(&relief);
    }
}

TEST(RealTimeTest, ForbiddenCallsAndSystemCallsAreDetected) {
    const std::uint64_t before = forbiddenCalls();
    std::mutex mutex;
    {
        const WatchedSection watched;
        std::free(std::malloc(16));
        const std::lock_guard lock(mutex);
    }
    EXPECT_GE(forbiddenCalls(), before + 3) << "malloc, free and the lock";
    const std::uint64_t trappedBefore = trappedSystemCalls();
    std::atomic<bool> hasFilter{false};
    std::thread thread([&hasFilter] {
        hasFilter = trapSystemCalls();
        (void)syscall(SYS_getppid);
        leaveThread();
    });
    thread.join();
    ASSERT_TRUE(hasFilter) << "this kernel does not let a thread filter its own system calls";
    EXPECT_EQ(trappedSystemCalls(), trappedBefore + 1);
    EXPECT_EQ(lastTrappedSystemCall(), SYS_getppid);
}

TEST(RealTimeTest, ForbiddenCallsInsideTheLibraryAreDetected) {
    const OpenEngine open(capi::testing::tinyModelPath);
    auto statistics = capi::testing::sized<haptoflow_engine_statistics>();
    const std::uint64_t before = forbiddenCalls();
    {
        const WatchedSection watched;
        EXPECT_EQ(haptoflow_engine_get_statistics(open.engine, &statistics), HAPTOFLOW_OK);
    }
    EXPECT_GT(forbiddenCalls(), before) << "this function takes a lock, as documented";
}

TEST(RealTimeTest, TheFirstCallMayComeFromTheAudioThread) {
    // Each test runs in its own process. A mixer group with the effect may play before any voice was created.
    std::array<float, 64> block{};
    block.fill(1.0F);
    const std::uint64_t before = forbiddenCalls();
    {
        const WatchedSection watched;
        (void)haptoflow_voice_render(257, block.data(), 64, 1, 0, 48000.0);
        (void)haptoflow_panic();
    }
    EXPECT_EQ(forbiddenCalls(), before) << "last: " << lastForbiddenCall();
    EXPECT_EQ(block, (std::array<float, 64>{})) << "a voice that is not open writes zeros";
}

/// Calls `callback(frames, rateHz)` like a device while `disturb` changes the voice, and asserts that it makes no
/// forbidden call.
template <typename Callback>
void watchUnderLoad(const OpenEngine& open, const Callback& callback) {
    const std::uint64_t callbacks = callbackCount();
    Pace pace;
    std::atomic<bool> hasFilter{false};
    const std::uint64_t forbiddenBefore = forbiddenCalls();
    const std::uint64_t trappedBefore = trappedSystemCalls();

    std::thread audio([&] {
        constexpr std::array rates{48000U, 48000U, 24000U};
        constexpr std::array<std::uint32_t, 4> blocks{64, 128, 31, 96};
        // The first allocation may create this thread's arena.
        std::free(std::malloc(16));
        hasFilter = trapSystemCalls();
        for (std::uint64_t i = 0; i < callbacks; ++i) {
            const WatchedSection watched;
            while (i >= pace.allowedCallbacks) {
                __builtin_ia32_pause();
            }
            callback(blocks[i % blocks.size()], rates[i / 4'000 % rates.size()]);
        }
        pace.done = true;
        leaveThread();
    });
    disturb(open.voice, pace);
    audio.join();

    ASSERT_TRUE(hasFilter);
    EXPECT_EQ(forbiddenCalls(), forbiddenBefore) << "last: " << lastForbiddenCall();
    EXPECT_EQ(trappedSystemCalls(), trappedBefore) << "last: " << lastTrappedSystemCall();
    // The callbacks must have rendered something.
    const haptoflow_voice_statistics statistics = open.statistics();
    EXPECT_GT(statistics.inferences, 10U);
    EXPECT_GT(statistics.onsets, 3U);
    EXPECT_GT(statistics.rate_changes, 0U);
    const haptoflow_effect_statistics listen = open.effect(HAPTOFLOW_EFFECT_LISTEN);
    EXPECT_GT(listen.prepared, 3U);
    EXPECT_GT(listen.runs, 1000U);
}

/// Results that the audio thread records.
struct OutputRecord {
    std::atomic<bool> isFinite{true};
    std::atomic<float> loudest{0.0F};

    void note(std::span<const float> block) noexcept {
        for (const float sample : block) {
            isFinite = isFinite && std::isfinite(sample);
            loudest = std::max(loudest.load(), std::abs(sample));
        }
    }
};

/// Plain callbacks of a model's voice.
void watchCallbacksOf(const std::string& modelPath) {
    const OpenEngine open(modelPath, true, HAPTOFLOW_QUALITY_STANDARD);
    OutputRecord record;
    std::array<float, 128> block{};
    watchUnderLoad(open, [&](std::uint32_t frames, std::uint32_t rateHz) {
        (void)haptoflow_voice_render(open.voice, block.data(), frames, 1, 0, rateHz);
        record.note(std::span(block).first(frames));
    });
    EXPECT_TRUE(record.isFinite);
    EXPECT_GT(record.loudest, 0.001F);
}

TEST(RealTimeTest, NoCallbackUnderLoadAllocatesLocksOrEntersTheKernel) {
    watchCallbacksOf(capi::testing::defaultModelPath);
}

TEST(RealTimeTest, NoCallbackThatSketchesAllocatesLocksOrEntersTheKernel) {
    watchCallbacksOf(HAPTOFLOW_TEST_GOLDEN_DIR "/model/skeleton.haptoflow");
}

TEST(RealTimeTest, NoCallbackOfASumWhoseVoicesComeAndGoAllocatesLocksOrEntersTheKernel) {
    const OpenEngine open(capi::testing::defaultModelPath, true, HAPTOFLOW_QUALITY_STANDARD);
    OutputRecord record;
    std::array<float, 128> block{};
    std::atomic<haptoflow_voice> other{0};
    std::atomic<bool> isOver{false};
    std::uint64_t ended = 0;
    std::thread changing([&] {
        const haptoflow_contact_state state = capi::testing::slidingState();
        while (!isOver) {
            haptoflow_voice voice = 0;
            ASSERT_EQ(haptoflow_voice_create(open.engine, 48000.0, &voice), HAPTOFLOW_OK);
            (void)haptoflow_voice_publish(voice, &state);
            other = voice;
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
            ASSERT_EQ(haptoflow_voice_destroy(&voice), HAPTOFLOW_OK);
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
    });
    watchUnderLoad(open, [&](std::uint32_t frames, std::uint32_t rateHz) {
        std::array<haptoflow_voice, 2> voices{open.voice, other};
        const bool isOpen = voices[1] != 0;
        (void)haptoflow_voices_render(voices.data(), 2, block.data(), frames, 1, 0, rateHz);
        ended += isOpen && voices[1] == 0 ? 1 : 0;
        record.note(std::span(block).first(frames));
    });
    isOver = true;
    changing.join();
    EXPECT_GT(ended, 3U);
    EXPECT_TRUE(record.isFinite);
    EXPECT_GT(record.loudest, 0.001F);
}

TEST(RealTimeTest, NoCallbackOfTheMixerEffectUnderLoadAllocatesLocksOrEntersTheKernel) {
    const OpenEngine open(capi::testing::defaultModelPath, true);
    const unity::testing::UnityHost host;
    unity::testing::HostedEffect effect(host.effect("HaptoFlow Voice"));
    std::uint32_t place = 0;
    ASSERT_EQ(haptoflow_voice_place(open.voice, &place), HAPTOFLOW_OK);
    const auto ownPlace = static_cast<float>(place);
    effect.set("Voice", ownPlace);
    effect.set("Channel", 1.0F);
    const unity::AudioEffectDefinition& definition = effect.definition();
    const int strength = effect.indexOf("Strength");
    const int voice = effect.indexOf("Voice");
    const int channel = effect.indexOf("Channel");
    OutputRecord record;
    std::array<float, 256> silence{};
    std::array<float, 256> block{};
    std::uint64_t calls = 0;
    watchUnderLoad(open, [&](std::uint32_t frames, std::uint32_t rateHz) {
        unity::AudioEffectState& state = effect.state();
        state.sampleRateHz = rateHz;
        state.flags = ++calls % 900 < 30 ? unity::flagPlaying | unity::flagPaused : unity::flagPlaying;
        if (calls % 50 == 0) {
            (void)definition.setParameter(&state, strength, calls % 100 == 0 ? 1.0F : 0.5F);
            (void)definition.setParameter(&state, channel, static_cast<float>(calls / 50 % 3) - 1.0F);
            (void)definition.setParameter(&state, voice, calls % 350 == 0 ? 40.0F : ownPlace);
            std::array<char, 16> text{};
            (void)definition.getParameter(&state, static_cast<int>(calls / 50 % 3), nullptr, text.data());
        }
        if (calls % 1'300 == 0) {
            (void)definition.reset(&state);
        }
        (void)definition.process(&state, silence.data(), block.data(), frames, 2, 2);
        state.previousTick = state.currentTick;
        // Occasionally the group was suspended.
        state.currentTick += calls % 1'700 == 0 ? 4 * frames : frames;
        record.note(std::span(block).first(std::size_t{2} * frames));
    });
    EXPECT_TRUE(record.isFinite);
    EXPECT_GT(record.loudest, 0.001F);
}

}  // namespace
}  // namespace haptoflow::realtime
