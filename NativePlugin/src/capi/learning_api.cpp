#include "capi/handles.hpp"
#include "learning/learner.hpp"
#include "learning/wave_vectors.hpp"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

using namespace haptoflow;
using namespace haptoflow::capi;

namespace haptoflow::capi {

struct OpenLearning {
    std::string material;
    std::string report;
};

}  // namespace haptoflow::capi

namespace {

constexpr double maximumLimitSeconds = 3600.0;

std::string textOrNone(const char* text) {
    return text != nullptr ? text : "";
}

recordings::Recording recordingOf(const haptoflow_learning_options& given) {
    (void)require(given.acceleration_mps2, "options: acceleration_mps2");
    if (given.axis_count != 1 && given.axis_count != 3) {
        throw std::invalid_argument("options: axis_count is " + std::to_string(given.axis_count) + "; expected 1 or 3");
    }
    const std::size_t count = countOf(given.sample_count, "options: sample_count");
    const auto numbers = [](const float* values, std::size_t size) {
        return values != nullptr ? std::span(values, size) : std::span<const float>();
    };
    return {.rateHz = given.sample_rate_hz,
            .axisCount = given.axis_count,
            .accelerationMps2 = numbers(given.acceleration_mps2, count * given.axis_count),
            .velocityMps = numbers(given.velocity_mps, 2 * count),
            .constantVelocityMps = {given.constant_velocity_mps[0], given.constant_velocity_mps[1]},
            .forceNewtons = numbers(given.force_newtons, count),
            .constantForceNewtons = given.constant_force_newtons};
}

learning::LearningSettings settingsOf(const haptoflow_learning_options& given,
                                      const inference::Cancellation* cancellation) {
    learning::LearningSettings settings;
    settings.name = require(given.name, "options: name");
    settings.category = textOrNone(given.category);
    settings.description = textOrNone(given.description);
    settings.licence = textOrNone(given.licence);
    settings.recordings = textOrNone(given.recordings);
    settings.keptLabel = textOrNone(given.label);
    settings.seed = given.seed;
    if (given.seconds_limit != 0.0) {
        if (!(given.seconds_limit > 0.0 && given.seconds_limit <= maximumLimitSeconds)) {
            throw std::invalid_argument("options: seconds_limit is " + std::to_string(given.seconds_limit) +
                                        "; expected above 0 to 3600, or 0 for 20");
        }
        settings.secondsLimit = given.seconds_limit;
    }
    if (given.wave_vectors != nullptr) {
        settings.waveVectors.emplace();
        std::copy_n(given.wave_vectors, settings.waveVectors->size(), settings.waveVectors->begin());
    }
    if (given.progress != nullptr) {
        settings.progress = [progress = given.progress, context = given.progress_context](
                                double share, const char* doing) { progress(context, share, doing); };
    }
    settings.cancellation = cancellation;
    return settings;
}

}  // namespace

haptoflow_status haptoflow_learn_material(const haptoflow_learning_options* options, haptoflow_learning** learning) {
    return guarded([&] {
        const auto given = readDescriptor(options, "options");
        (void)require(learning, "learning");
        const auto runtime = runtimeOf(given.runtime);
        const auto open = models().get(given.model);
        const model::Tier& tier = tierNamed(open->model, given.tier);
        const inference::LoadLimits limits = loadLimits(given.cancellation, 0.0);
        const recordings::Recording recording = recordingOf(given);
        const learning::LearningSettings settings = settingsOf(given, limits.cancellation.get());
        learning::checkSettings(settings);
        recordings::checkRecording(recording);
        learning::LearntMaterial learnt =
            learning::learnMaterial(recording, open->model, tier, runtime, settings, limits);
        *learning = learnings().open(std::make_shared<const OpenLearning>(
            OpenLearning{std::move(learnt.materialJson), learning::reportJson(learnt.report)}));
    });
}

haptoflow_status haptoflow_learning_material(const haptoflow_learning* learning, const char** json) {
    return guarded([&] { *require(json, "json") = learnings().get(learning)->material.c_str(); });
}

haptoflow_status haptoflow_learning_report(const haptoflow_learning* learning, const char** json) {
    return guarded([&] { *require(json, "json") = learnings().get(learning)->report.c_str(); });
}

haptoflow_status haptoflow_learning_close(haptoflow_learning** learning) {
    return guarded([&] { closeHandle(learnings(), learning, "learning"); });
}

haptoflow_status haptoflow_find_wave_vectors(const float* vibration_mps2, const float* velocity_mps,
                                             uint64_t sample_count, double* wave_vectors) {
    return guarded([&] {
        (void)require(vibration_mps2, "vibration_mps2");
        (void)require(velocity_mps, "velocity_mps");
        const std::span<double, 2 * inference::ribCount> result(require(wave_vectors, "wave_vectors"),
                                                                2 * inference::ribCount);
        const std::size_t count = countOf(sample_count, "sample_count");
        const std::vector<learning::WaveVector> found =
            learning::findWaveVectors({vibration_mps2, count}, {velocity_mps, 2 * count});
        std::ranges::fill(result, 0.0);
        for (std::size_t rib = 0; rib < found.size(); ++rib) {
            result[2 * rib] = found[rib].x;
            result[2 * rib + 1] = found[rib].y;
        }
    });
}
