#include "capi/handles.hpp"
#include "dsp/sample_rates.hpp"
#include "learning/learner.hpp"
#include "learning/wave_vectors.hpp"
#include "recordings/prepared_recording.hpp"
#include "recordings/recording_reader.hpp"
#include "recordings/sensor_noise.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

using namespace haptoflow;
using namespace haptoflow::capi;

static_assert(static_cast<int>(recordings::NoiseSource::rest) == HAPTOFLOW_NOISE_REST);
static_assert(static_cast<int>(recordings::NoiseSource::quietPart) == HAPTOFLOW_NOISE_QUIET_PART);

namespace haptoflow::capi {

struct OpenRecording {
    recordings::MaterialRecording recording;
    std::filesystem::path path;
    std::string motionPath;
    std::string notes;
    std::string materialName;
    std::string provenance;
};

struct OpenLearning {
    std::string material;
    std::string report;
};

}  // namespace haptoflow::capi

namespace {

constexpr double maximumLimitSeconds = 3600.0;
constexpr double unknownNumber = std::numeric_limits<double>::quiet_NaN();

std::string textOr(const char* text, const std::string& otherwise) {
    const std::string given = textOf(text);
    return given.empty() ? otherwise : given;
}

std::optional<double> fullScaleOrNone(double value) {
    if (value == 0.0) {
        return std::nullopt;
    }
    if (!(value > 0.0) || value > std::numeric_limits<float>::max()) {
        throw std::invalid_argument("options: full_scale_mps2 is " + std::to_string(value) +
                                    "; expected above 0, or 0 for unknown");
    }
    return value;
}

std::unique_ptr<recordings::RecordingFiles> filesOf(const haptoflow_recording_options& given) {
    if (given.file_count == 0) {
        return std::make_unique<recordings::DiskFiles>();
    }
    std::map<std::string, std::span<const char>> files;
    for (const haptoflow_recording_file& file : std::span(require(given.files, "options: files"), given.file_count)) {
        const auto* bytes = static_cast<const char*>(file.bytes);
        if (bytes == nullptr && file.byte_count > 0) {
            throw std::invalid_argument("options: a file's bytes are null");
        }
        files.emplace(require(file.name, "options: a file's name"),
                      std::span(bytes, static_cast<std::size_t>(file.byte_count)));
    }
    return std::make_unique<recordings::GivenFiles>(std::move(files));
}

haptoflow_track trackOf(const recordings::Track& track) {
    if (track.count() == 0) {
        return {};
    }
    return {.seconds = track.timeSeconds.data(),
            .values = track.values.data(),
            .count = track.count(),
            .width = track.width};
}

const float* dataOrNull(const std::vector<float>& values) {
    return values.empty() ? nullptr : values.data();
}

haptoflow_recording_info infoOf(const OpenRecording& open) {
    const recordings::MaterialRecording& recording = open.recording;
    const auto velocity = recording.constantVelocityMps.value_or(std::array{unknownNumber, unknownNumber});
    haptoflow_recording_info info{};
    info.axis_count = static_cast<uint32_t>(recording.axisCount);
    info.sample_rate_hz = recording.rateHz;
    info.sample_count = recording.view().sampleCount();
    info.acceleration_mps2 = dataOrNull(recording.accelerationMps2);
    info.velocity_mps = dataOrNull(recording.velocityMps);
    info.force_newtons = dataOrNull(recording.forceNewtons);
    info.constant_velocity_mps[0] = velocity[0];
    info.constant_velocity_mps[1] = velocity[1];
    info.constant_force_newtons = recording.constantForceNewtons.value_or(unknownNumber);
    info.acceleration = trackOf(recording.tracks.acceleration);
    info.motion = trackOf(recording.tracks.motion);
    info.force = trackOf(recording.tracks.force);
    info.motion_is_position = recording.tracks.hasPositions ? 1U : 0U;
    info.label = recording.description.label.c_str();
    info.licence = recording.description.licence.c_str();
    info.source = recording.description.source.c_str();
    info.motion_path = open.motionPath.c_str();
    info.notes = open.notes.c_str();
    info.material_name = open.materialName.c_str();
    info.provenance = open.provenance.c_str();
    return info;
}

/// A copy of the caller's samples and texts. Throws std::invalid_argument.
OpenRecording copyOf(const haptoflow_recording_info& given) {
    (void)require(given.acceleration_mps2, "info: acceleration_mps2");
    const std::size_t count = countOf(given.sample_count, "info: sample_count");
    // Before that many samples are read.
    recordings::checkSizes({.rateHz = given.sample_rate_hz, .axisCount = given.axis_count});
    const auto copied = [](const float* values, std::size_t size) {
        return values != nullptr ? std::vector(values, values + size) : std::vector<float>();
    };
    OpenRecording open;
    recordings::MaterialRecording& recording = open.recording;
    recording.rateHz = given.sample_rate_hz;
    recording.axisCount = given.axis_count;
    recording.accelerationMps2 = copied(given.acceleration_mps2, count * given.axis_count);
    recording.velocityMps = copied(given.velocity_mps, 2 * count);
    recording.forceNewtons = copied(given.force_newtons, count);
    // Constants of what is not constant are no numbers.
    if (given.velocity_mps == nullptr) {
        recording.constantVelocityMps = {given.constant_velocity_mps[0], given.constant_velocity_mps[1]};
    }
    if (given.force_newtons == nullptr) {
        recording.constantForceNewtons = given.constant_force_newtons;
    }
    recordings::checkSizes(recording.view());
    recording.description.label = textOf(given.label);
    recording.description.licence = textOf(given.licence);
    recording.description.source = textOf(given.source);
    open.notes = textOf(given.notes);
    open.materialName = textOf(given.material_name);
    open.provenance = textOf(given.provenance);
    return open;
}

/// The recording with the caller's speed and force where it has none. Throws RecordingUnusable if one is still unknown.
recordings::Recording completed(const OpenRecording& open, const haptoflow_learning_options& given) {
    recordings::Recording recording = open.recording.view();
    const bool hasMotion = open.recording.hasMotion();
    const bool hasForce = open.recording.hasForce();
    recordings::requireMotionAndForce(open.recording.description, open.path, hasMotion || given.speed_mps != 0.0,
                                      hasForce || given.force_newtons != 0.0);
    if (!hasMotion) {
        recording.constantVelocityMps = {given.speed_mps, 0.0};
    }
    if (!hasForce) {
        recording.constantForceNewtons = given.force_newtons;
    }
    return recording;
}

learning::LearningSettings settingsOf(const haptoflow_learning_options& given, const OpenRecording& recording,
                                      const inference::Cancellation* cancellation) {
    learning::LearningSettings settings;
    settings.name = textOr(given.name, recording.materialName);
    settings.category = textOf(given.category);
    settings.description = textOf(given.description);
    settings.licence = textOr(given.licence, recording.recording.description.licence);
    settings.recordings = recording.provenance;
    settings.keptLabel = textOf(given.label);
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

template <typename Number>
void writeWave(const std::vector<Number>& wave, std::span<float> written) {
    std::ranges::fill(written, 0.0F);
    std::ranges::transform(std::span(wave).first(std::min(wave.size(), written.size())), written.begin(),
                           [](Number value) { return static_cast<float>(value); });
}

}  // namespace

haptoflow_status haptoflow_recording_read(const haptoflow_recording_options* options, haptoflow_recording** recording) {
    return guarded([&] {
        const auto given = readDescriptor(options, "options");
        (void)require(recording, "recording");
        const std::filesystem::path path = utf8Path(require(given.path, "options: path"));
        const recordings::RecordingWords words{.fullScaleMps2 = fullScaleOrNone(given.full_scale_mps2)};
        const std::unique_ptr<recordings::RecordingFiles> files = filesOf(given);
        auto open = std::make_shared<OpenRecording>();
        if (given.without_samples != 0) {
            open->recording.description = recordings::describeRecording(*files, path);
        } else {
            open->recording = recordings::readMaterialRecording(*files, path, words);
            if (given.needs_motion_and_force != 0) {
                recordings::requireMotionAndForce(open->recording.description, path, open->recording.hasMotion(),
                                                  open->recording.hasForce());
            }
        }
        open->path = path;
        const recordings::RecordingDescription& description = open->recording.description;
        open->materialName = recordings::materialName(description, path);
        open->provenance = recordings::provenanceOf(description, path);
        open->motionPath = description.motion ? recordings::utf8Of(*description.motion) : "";
        for (const std::string& note : description.notes) {
            open->notes.append(open->notes.empty() ? "" : "\n").append(note);
        }
        *recording = openRecordings().open(std::move(open));
    });
}

haptoflow_status haptoflow_recording_create(const haptoflow_recording_info* info, haptoflow_recording** recording) {
    return guarded([&] {
        const auto given = readDescriptor(info, "info");
        (void)require(recording, "recording");
        *recording = openRecordings().open(std::make_shared<OpenRecording>(copyOf(given)));
    });
}

haptoflow_status haptoflow_recording_get_info(const haptoflow_recording* recording, haptoflow_recording_info* info) {
    return guarded([&] { writeDescriptor(info, infoOf(*openRecordings().get(recording)), "info"); });
}

haptoflow_status haptoflow_recording_wave(const haptoflow_recording* recording, float* wave_mps2, uint64_t wave_count) {
    return guarded([&] {
        const auto open = openRecordings().get(recording);
        const std::span wave(require(wave_mps2, "wave_mps2"), countOf(wave_count, "wave_count"));
        recordings::Recording beginning = open->recording.view();
        recordings::checkSizes(beginning);
        const double needed = std::ceil(static_cast<double>(wave.size()) / dsp::waveformRateHz * beginning.rateHz);
        const std::size_t count = std::min(beginning.sampleCount(), static_cast<std::size_t>(needed));
        beginning.accelerationMps2 = beginning.accelerationMps2.first(count * beginning.axisCount);
        writeWave(recordings::combinedWave(beginning), wave);
    });
}

haptoflow_status haptoflow_recording_remove_noise(float* vibration_mps2, const float* velocity_mps,
                                                  const float* force_newtons, uint64_t sample_count,
                                                  haptoflow_noise_source* source, double* noise_mps2) {
    return guarded([&] {
        const std::size_t count = countOf(sample_count, "sample_count");
        const std::span wave(require(vibration_mps2, "vibration_mps2"), count);
        const std::span velocity(require(velocity_mps, "velocity_mps"), 2 * count);
        const std::span force(require(force_newtons, "force_newtons"), count);
        (void)require(source, "source");
        (void)require(noise_mps2, "noise_mps2");
        std::vector<float> known(count);
        std::vector<std::array<float, 3>> motion(count);
        std::vector<std::uint8_t> isUsable(count);
        for (std::size_t i = 0; i < count; ++i) {
            motion[i] = {velocity[2 * i], velocity[2 * i + 1], force[i]};
            isUsable[i] = std::isfinite(wave[i]) &&
                          std::ranges::all_of(motion[i], [](float value) { return std::isfinite(value); });
            known[i] = isUsable[i] != 0 ? wave[i] : 0.0F;
        }
        const recordings::SensorNoise noise = recordings::removeSensorNoise(known, motion, isUsable);
        for (std::size_t i = 0; i < count; ++i) {
            wave[i] = isUsable[i] != 0 ? known[i] : wave[i];
        }
        *source = static_cast<haptoflow_noise_source>(noise.source);
        *noise_mps2 = noise.rmsMps2;
    });
}

haptoflow_status haptoflow_resample(const float* samples, uint64_t sample_count, double sample_rate_hz, float* wave,
                                    uint64_t wave_count, double wave_rate_hz) {
    return guarded([&] {
        const recordings::Channel channel{.first = require(samples, "samples"),
                                          .count = countOf(sample_count, "sample_count")};
        const std::span written(require(wave, "wave"), countOf(wave_count, "wave_count"));
        for (const double rateHz : {sample_rate_hz, wave_rate_hz}) {
            if (!(rateHz >= recordings::lowestRateHz && rateHz <= recordings::highestRateHz)) {
                throw std::invalid_argument("a rate is " + recordings::plainNumber(rateHz) +
                                            " Hz; expected 1000 to 192000 Hz");
            }
        }
        writeWave(recordings::resampled(channel, sample_rate_hz, wave_rate_hz), written);
    });
}

haptoflow_status haptoflow_recording_close(haptoflow_recording** recording) {
    return guarded([&] { closeHandle(openRecordings(), recording, "recording"); });
}

haptoflow_status haptoflow_learn_material(const haptoflow_learning_options* options, haptoflow_learning** learning) {
    return guarded([&] {
        const auto given = readDescriptor(options, "options");
        (void)require(learning, "learning");
        const auto runtime = runtimeOf(given.runtime);
        const auto open = models().get(given.model);
        const model::Tier& tier = tierNamed(open->model, given.tier);
        const inference::LoadLimits limits = loadLimits(given.cancellation, 0.0);
        const auto openRecording = openRecordings().get(given.recording);
        const learning::LearningSettings settings = settingsOf(given, *openRecording, limits.cancellation.get());
        const recordings::Recording recording = completed(*openRecording, given);
        learning::LearntMaterial learnt =
            learning::learnMaterial(recording, open->model, tier, runtime, settings, limits);
        *learning = learnings().open(std::make_shared<const OpenLearning>(
            OpenLearning{std::move(learnt.materialJson), learning::reportJson(learnt.report)}));
    });
}

haptoflow_status haptoflow_learning_results(const haptoflow_learning* learning, const char** material,
                                            const char** report) {
    return guarded([&] {
        const auto open = learnings().get(learning);
        (void)require(material, "material");
        *require(report, "report") = open->report.c_str();
        *material = open->material.c_str();
    });
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
