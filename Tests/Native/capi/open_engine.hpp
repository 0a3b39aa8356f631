#pragma once

#include "open_handles.hpp"
#include "support/wave_measures.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace haptoflow::capi::testing {

inline const std::string defaultModelPath = HAPTOFLOW_TEST_DEFAULT_MODEL;

inline haptoflow_contact_state slidingState(float speedMps = 0.1F, float forceNewtons = 1.0F) {
    haptoflow_contact_state state{};
    state.struct_size = sizeof(state);
    state.touching = 1;
    state.touch_counter = 1;
    state.label_count = 1;
    state.weights[0] = 1.0F;
    state.velocity_mps[0] = speedMps;
    state.force_newtons = forceNewtons;
    return state;
}

inline haptoflow_contact_state liftedState(uint32_t touchCounter = 1) {
    haptoflow_contact_state state{};
    state.struct_size = sizeof(state);
    state.touch_counter = touchCounter;
    return state;
}

/// An engine with one voice. Without a worker it is stepped after each update, so that its output is deterministic.
class OpenEngine {
public:
    explicit OpenEngine(const std::string& modelPath, bool hasWorker = false,
                        haptoflow_quality quality = HAPTOFLOW_QUALITY_DRAFT, uint64_t seed = 1,
                        double rateHz = 48000.0) {
        const haptoflow_model_options modelOptions{sizeof(modelOptions), nullptr, 0, modelPath.c_str()};
        EXPECT_EQ(haptoflow_model_open(&modelOptions, &model), HAPTOFLOW_OK) << message();
        haptoflow_engine_options options{};
        options.struct_size = sizeof(options);
        options.quality = quality;
        options.runtime = runtime;
        options.model = model;
        options.seed = seed;
        options.without_worker = hasWorker ? 0 : 1;
        options.fixed_lead_ms = hasWorker ? 0.0 : 8.0;
        EXPECT_EQ(haptoflow_engine_create(&options, &engine), HAPTOFLOW_OK) << message();
        EXPECT_EQ(haptoflow_voice_create(engine, rateHz, &voice), HAPTOFLOW_OK) << message();
    }
    OpenEngine(const OpenEngine&) = delete;
    OpenEngine& operator=(const OpenEngine&) = delete;
    ~OpenEngine() {
        EXPECT_EQ(haptoflow_engine_close(&engine), HAPTOFLOW_OK);
        EXPECT_EQ(haptoflow_model_close(&model), HAPTOFLOW_OK);
        EXPECT_EQ(haptoflow_runtime_close(&runtime), HAPTOFLOW_OK);
    }

    void publish(const haptoflow_contact_state& state) {
        EXPECT_EQ(haptoflow_voice_publish(voice, &state), HAPTOFLOW_OK) << message();
    }
    std::vector<float> render(uint32_t frames, double rateHz = 48000.0) {
        std::vector<float> samples(frames);
        EXPECT_EQ(haptoflow_voice_render(voice, samples.data(), frames, 1, 0, rateHz), HAPTOFLOW_OK);
        return samples;
    }
    /// Publishes one contact state, runs inference and returns the output until the next update.
    std::vector<float> update(const haptoflow_contact_state& state, uint32_t frames = 667) {
        publish(state);
        std::vector<float> output = render(1);
        EXPECT_EQ(haptoflow_engine_step(engine), HAPTOFLOW_OK) << message();
        const std::vector<float> rest = render(frames - 1);
        output.insert(output.end(), rest.begin(), rest.end());
        return output;
    }
    [[nodiscard]] haptoflow_voice_statistics statistics() const {
        haptoflow_voice_statistics statistics{};
        statistics.struct_size = sizeof(statistics);
        EXPECT_EQ(haptoflow_voice_get_statistics(voice, &statistics), HAPTOFLOW_OK);
        return statistics;
    }
    [[nodiscard]] haptoflow_engine_statistics engineStatistics() const {
        haptoflow_engine_statistics statistics{};
        statistics.struct_size = sizeof(statistics);
        EXPECT_EQ(haptoflow_engine_get_statistics(engine, &statistics), HAPTOFLOW_OK);
        return statistics;
    }

    haptoflow_runtime* runtime = openRuntime();
    haptoflow_model* model = nullptr;
    haptoflow_engine* engine = nullptr;
    haptoflow_voice voice = 0;
};

using haptoflow::testing::largestStep;
using haptoflow::testing::largestStepFrom;
using haptoflow::testing::peak;

inline bool allFinite(const std::vector<float>& samples) {
    return std::all_of(samples.begin(), samples.end(), [](float sample) { return std::isfinite(sample); });
}

}  // namespace haptoflow::capi::testing
