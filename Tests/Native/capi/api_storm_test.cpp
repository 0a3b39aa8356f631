// Random sequences of calls, right and wrong ones, from several threads at once. What they prove, they prove under the
// sanitizers: no crash, no race, no leak; and here that every status is a known one and every sample finite.
#include "open_engine.hpp"

#include <cstdint>
#include <cstdlib>
#include <limits>
#include <mutex>
#include <random>
#include <thread>

namespace haptoflow::capi::testing {
namespace {

/// Handles that threads share, open ones and stale ones alike.
class SharedHandles {
public:
    void put(haptoflow_engine* engine) {
        const std::lock_guard lock(mutex_);
        engines_.push_back(engine);
    }
    void put(haptoflow_voice voice) {
        const std::lock_guard lock(mutex_);
        voices_.push_back(voice);
    }
    haptoflow_engine* engine(std::uint32_t choice) {
        const std::lock_guard lock(mutex_);
        return engines_.empty() || choice % 11 == 0 ? nullptr : engines_[choice % engines_.size()];
    }
    haptoflow_voice voice(std::uint32_t choice) {
        const std::lock_guard lock(mutex_);
        return voices_.empty() || choice % 11 == 0 ? choice : voices_[choice % voices_.size()];
    }

private:
    std::mutex mutex_;
    std::vector<haptoflow_engine*> engines_;
    std::vector<haptoflow_voice> voices_;
};

class Storm {
public:
    Storm(SharedHandles& handles, const haptoflow_runtime* runtime, const haptoflow_model* model, std::uint32_t seed)
        : handles_(handles), runtime_(runtime), model_(model), random_(seed) {}

    void run(int calls) {
        for (int call = 0; call < calls; ++call) {
            check(once());
        }
    }
    [[nodiscard]] bool isSound() const { return isSound_; }

private:
    std::uint32_t next() { return static_cast<std::uint32_t>(random_()); }

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

    haptoflow_contact_state wildState() {
        haptoflow_contact_state state = slidingState();
        state.touching = next() % 4;
        state.touch_counter = next() % 5;
        state.label_count = next() % 16 == 0 ? next() : next() % 5;
        for (std::size_t i = 0; i < HAPTOFLOW_MAXIMUM_BLEND; ++i) {
            state.labels[i] = next() % 8 == 0 ? next() : next() % 4;
            state.weights[i] = wildFloat();
        }
        state.velocity_mps[0] = wildFloat();
        state.velocity_mps[1] = wildFloat();
        state.force_newtons = wildFloat();
        state.struct_size = next() % 32 == 0 ? next() % 80 : sizeof(state);
        return state;
    }

    haptoflow_status createEngine() {
        haptoflow_engine_options options{};
        options.struct_size = sizeof(options);
        options.quality = static_cast<haptoflow_quality>(next() % 5);
        options.runtime = runtime_;
        options.model = model_;
        options.without_worker = next() % 3 == 0 ? 1 : 0;
        haptoflow_engine* engine = nullptr;
        const haptoflow_status status = haptoflow_engine_create(&options, &engine);
        if (status == HAPTOFLOW_OK) {
            handles_.put(engine);
        }
        return status;
    }

    haptoflow_status createVoice() {
        constexpr std::array rates{48000.0, 24000.0, 0.0, 1.0};
        haptoflow_voice voice = 0;
        const haptoflow_status status =
            haptoflow_voice_create(handles_.engine(next()), rates[next() % rates.size()], &voice);
        if (status == HAPTOFLOW_OK) {
            handles_.put(voice);
        }
        return status;
    }

    haptoflow_status render() {
        constexpr std::array rates{48000.0, 48000.0, 48000.0, 44100.0, -1.0};
        std::vector<float> block(1 + next() % 600);
        const haptoflow_status status =
            haptoflow_voice_render(handles_.voice(next()), block.data(), static_cast<std::uint32_t>(block.size()), 1, 0,
                                   rates[next() % rates.size()]);
        isSound_ = isSound_ && allFinite(block) && peak(block) <= 1.0F;
        return status;
    }

    haptoflow_status once() {
        const std::uint32_t kind = next() % 200;
        if (kind < 90) {
            return render();
        }
        if (kind < 160) {
            const haptoflow_contact_state state = wildState();
            return haptoflow_voice_publish(handles_.voice(next()), next() % 50 == 0 ? nullptr : &state);
        }
        if (kind < 166) {
            return createVoice();
        }
        if (kind < 172) {
            haptoflow_voice voice = handles_.voice(next());
            return haptoflow_voice_destroy(&voice);
        }
        if (kind < 173) {
            return createEngine();
        }
        if (kind < 174) {
            haptoflow_engine* engine = handles_.engine(next());
            return haptoflow_engine_close(&engine);
        }
        return command(kind);
    }

    haptoflow_status command(std::uint32_t kind) {
        const haptoflow_voice voice = handles_.voice(next());
        haptoflow_engine* engine = handles_.engine(next());
        haptoflow_voice_statistics statistics{};
        statistics.struct_size = sizeof(statistics);
        haptoflow_engine_statistics engineStatistics{};
        engineStatistics.struct_size = sizeof(engineStatistics);
        switch (kind % 9) {
            case 0:
                return haptoflow_voice_set_strength(voice, wildFloat());
            case 1:
                return haptoflow_voice_set_muted(voice, next() % 2);
            case 2:
                return haptoflow_voice_set_paused(voice, next() % 2);
            case 3:
                return haptoflow_voice_panic(voice);
            case 4:
                return haptoflow_voice_get_statistics(voice, &statistics);
            case 5:
                return haptoflow_engine_set_quality(engine, static_cast<haptoflow_quality>(next() % 5));
            case 6:
                return haptoflow_engine_step(engine);
            case 7:
                return haptoflow_engine_get_statistics(engine, &engineStatistics);
            default:
                return haptoflow_panic();
        }
    }

    void check(haptoflow_status status) {
        isSound_ =
            isSound_ && (status == HAPTOFLOW_OK || status == HAPTOFLOW_INVALID_ARGUMENT || status == HAPTOFLOW_BUSY);
    }

    SharedHandles& handles_;
    const haptoflow_runtime* runtime_;
    const haptoflow_model* model_;
    std::mt19937 random_;
    bool isSound_ = true;
};

class ApiStormTest : public WithTinyModel {
protected:
    /// HAPTOFLOW_TEST_STORM_CALLS: how many calls each thread makes; the soak asks for many.
    static int callsOfAThread(int usual) {
        const char* asked = std::getenv("HAPTOFLOW_TEST_STORM_CALLS");
        return asked != nullptr ? std::atoi(asked) : usual;
    }

    void storm(int threadCount, int calls) {
        SharedHandles handles;
        std::vector<Storm> storms;
        for (int i = 0; i < threadCount; ++i) {
            storms.emplace_back(handles, runtime_, model_, static_cast<std::uint32_t>(i + 1));
        }
        std::vector<std::thread> threads;
        for (Storm& each : storms) {
            threads.emplace_back([&each, calls] { each.run(calls); });
        }
        for (std::thread& thread : threads) {
            thread.join();
        }
        for (const Storm& each : storms) {
            EXPECT_TRUE(each.isSound());
        }
        // Engines that the storm left open end here; those it closed are refused.
        for (std::uint32_t i = 1; i < 4000; ++i) {
            haptoflow_engine* engine = handles.engine(i);
            (void)haptoflow_engine_close(&engine);
        }
    }
};

TEST_F(ApiStormTest, AnySequenceOfCallsFromOneThreadIsAnswered) {
    storm(1, callsOfAThread(4000));
}

TEST_F(ApiStormTest, AnySequenceOfCallsFromFourThreadsIsAnswered) {
    storm(4, callsOfAThread(2500));
}

}  // namespace
}  // namespace haptoflow::capi::testing
