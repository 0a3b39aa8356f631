#pragma once

#include "open_handles.hpp"
#include "support/wave_measures.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace haptoflow::capi::testing {

using haptoflow::testing::largestStep;
using haptoflow::testing::largestStepFrom;
using haptoflow::testing::peak;

inline haptoflow_contact_state slidingState(float speedMps = 0.1F, float forceNewtons = 1.0F) {
    auto state = sized<haptoflow_contact_state>();
    state.touching = 1;
    state.touch_counter = 1;
    state.label_count = 1;
    state.weights[0] = 1.0F;
    state.velocity_mps[0] = speedMps;
    state.force_newtons = forceNewtons;
    return state;
}

inline haptoflow_contact_state liftedState(uint32_t touchCounter = 1) {
    auto state = sized<haptoflow_contact_state>();
    state.touch_counter = touchCounter;
    return state;
}

/// An engine with one voice. Without a worker it is stepped after each update.
class OpenEngine {
public:
    explicit OpenEngine(const std::string& modelPath, bool hasWorker = false,
                        haptoflow_quality quality = HAPTOFLOW_QUALITY_DRAFT, uint64_t seed = 1, double rateHz = 48000.0)
        : model(openModel(modelPath)) {
        haptoflow_engine_options options = engineOptions(runtime, model, quality, hasWorker);
        options.seed = seed;
        *engine.out() = createEngine(options);
        EXPECT_EQ(haptoflow_voice_create(engine, rateHz, &voice), HAPTOFLOW_OK) << message();
    }

    void publish(const haptoflow_contact_state& state) {
        EXPECT_EQ(haptoflow_voice_publish(voice, &state), HAPTOFLOW_OK) << message();
    }
    void step() { EXPECT_EQ(haptoflow_engine_step(engine), HAPTOFLOW_OK) << message(); }
    std::vector<float> render(uint32_t frames, double rateHz = 48000.0) {
        std::vector<float> samples(frames);
        EXPECT_EQ(haptoflow_voice_render(voice, samples.data(), frames, 1, 0, rateHz), HAPTOFLOW_OK);
        return samples;
    }
    /// Publishes one contact state, runs inference and returns the output until the next update.
    std::vector<float> update(const haptoflow_contact_state& state, uint32_t frames = 667) {
        publish(state);
        std::vector<float> output = render(1);
        step();
        const std::vector<float> rest = render(frames - 1);
        output.insert(output.end(), rest.begin(), rest.end());
        return output;
    }
    /// The output of so many updates, each with the state of its number.
    std::vector<float> play(int updates, const std::function<haptoflow_contact_state(int)>& stateOf) {
        std::vector<float> output;
        for (int number = 0; number < updates; ++number) {
            const std::vector<float> next = update(stateOf(number));
            output.insert(output.end(), next.begin(), next.end());
        }
        return output;
    }
    std::vector<float> play(int updates, const haptoflow_contact_state& state = slidingState()) {
        return play(updates, [&state](int) { return state; });
    }
    [[nodiscard]] haptoflow_voice_statistics statistics() const { return statisticsOf(voice); }
    [[nodiscard]] haptoflow_engine_statistics engineStatistics() const { return statisticsOf(engine); }
    [[nodiscard]] haptoflow_effect_statistics effect(haptoflow_effect effect) const {
        auto statistics = sized<haptoflow_effect_statistics>();
        EXPECT_EQ(haptoflow_voice_effect_statistics(voice, effect, &statistics), HAPTOFLOW_OK) << message();
        return statistics;
    }

    RuntimeHandle runtime{openRuntime()};
    ModelHandle model;
    EngineHandle engine;
    haptoflow_voice voice = 0;
};

inline bool allFinite(const std::vector<float>& samples) {
    return std::ranges::all_of(samples, [](float sample) { return std::isfinite(sample); });
}

}  // namespace haptoflow::capi::testing
