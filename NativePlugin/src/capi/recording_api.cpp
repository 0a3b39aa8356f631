#include "capi/handles.hpp"
#include "recordings/material_words.hpp"
#include "recordings/noise_removal.hpp"
#include "recordings/prepared_recording.hpp"
#include "recordings/recording_reader.hpp"
#include "recordings/resampling.hpp"

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

namespace haptoflow::capi {

struct OpenRecording {
    recordings::MaterialRecording recording;
    std::string motionPath;
    std::string notes;
    std::string materialName;
    std::string provenance;
};

}  // namespace haptoflow::capi

namespace {

constexpr double unknownNumber = std::numeric_limits<double>::quiet_NaN();

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

haptoflow_noise_source sourceOf(recordings::NoiseSource source) {
    switch (source) {
        case recordings::NoiseSource::rest:
            return HAPTOFLOW_NOISE_REST;
        case recordings::NoiseSource::quietPart:
            return HAPTOFLOW_NOISE_QUIET_PART;
        case recordings::NoiseSource::none:
            break;
    }
    return HAPTOFLOW_NOISE_NONE;
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
                recordings::requireMotionAndForce(open->recording, path);
            }
        }
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

haptoflow_status haptoflow_recording_get_info(const haptoflow_recording* recording, haptoflow_recording_info* info) {
    return guarded([&] { writeDescriptor(info, infoOf(*openRecordings().get(recording)), "info"); });
}

haptoflow_status haptoflow_recording_wave(const float* acceleration_mps2, uint64_t sample_count, uint32_t axis_count,
                                          double sample_rate_hz, float* wave_mps2, uint64_t wave_count) {
    return guarded([&] {
        const std::span acceleration(require(acceleration_mps2, "acceleration_mps2"),
                                     countOf(sample_count, "sample_count") * axis_count);
        const std::span wave(require(wave_mps2, "wave_mps2"), countOf(wave_count, "wave_count"));
        const recordings::Recording recording{
            .rateHz = sample_rate_hz, .axisCount = axis_count, .accelerationMps2 = acceleration};
        recordings::checkSizes(recording);
        writeWave(recordings::prepareRecording(recording).wave, wave);
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
        *source = sourceOf(noise.source);
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
