#include "capi/handles.hpp"
#include "effects/device_loudness.hpp"
#include "effects/wave_features.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <mutex>
#include <span>
#include <stdexcept>
#include <string>

using namespace haptoflow;
using namespace haptoflow::capi;

namespace haptoflow::capi {

struct OpenDeviceWave {
    explicit OpenDeviceWave(double sampleRateHz) : wave(effects::deviceWave(sampleRateHz)) {}

    std::mutex mutex;
    effects::EnvelopeGain wave;
};

}  // namespace haptoflow::capi

static_assert(static_cast<int>(effects::DeviceKind::motor) == HAPTOFLOW_DEVICE_MOTOR);
static_assert(static_cast<int>(effects::DeviceKind::parametric) == HAPTOFLOW_DEVICE_PARAMETRIC);
static_assert(static_cast<int>(effects::DeviceKind::waveform) == HAPTOFLOW_DEVICE_WAVEFORM);

haptoflow_status haptoflow_device_share(haptoflow_device_kind kind, float amplitude_mps2, float* share) {
    return guarded([&] {
        (void)require(share, "share");
        if (kind < 0 || kind >= static_cast<haptoflow_device_kind>(effects::deviceKinds)) {
            throw std::invalid_argument("kind is " + std::to_string(kind) + "; expected 0 to 2");
        }
        *share = effects::deviceShare(static_cast<effects::DeviceKind>(kind), amplitude_mps2);
    });
}

haptoflow_status haptoflow_device_wave_create(double sample_rate_hz, haptoflow_device_wave** wave) {
    return guarded([&] {
        (void)require(wave, "wave");
        *wave = deviceWaves().open(std::make_shared<OpenDeviceWave>(sample_rate_hz));
    });
}

haptoflow_status haptoflow_device_wave_close(haptoflow_device_wave** wave) {
    return guarded([&] { closeHandle(deviceWaves(), wave, "wave"); });
}

haptoflow_status haptoflow_device_wave_reset(haptoflow_device_wave* wave) {
    return guarded([&] {
        const auto open = deviceWaves().get(wave);
        const std::lock_guard lock(open->mutex);
        open->wave.reset();
    });
}

haptoflow_status haptoflow_device_wave_process(haptoflow_device_wave* wave, float* samples, uint64_t sample_count,
                                               float full_scale_mps2) {
    return guarded([&] {
        if (sample_count > 0) {
            (void)require(samples, "samples");
        }
        if (!(std::isfinite(full_scale_mps2) && full_scale_mps2 > 0.0F)) {
            throw std::invalid_argument("full_scale_mps2 is " + std::to_string(full_scale_mps2) +
                                        "; expected a finite number above 0");
        }
        const auto open = deviceWaves().get(wave);
        const std::lock_guard lock(open->mutex);
        const std::span<float> block(samples, static_cast<std::size_t>(sample_count));
        std::ranges::for_each(block, [full_scale_mps2](float& sample) { sample *= full_scale_mps2; });
        open->wave.process(block);
    });
}

namespace haptoflow::capi {

std::size_t decimationOf(uint32_t sampleRateHz) {
    constexpr auto featureHz = static_cast<uint32_t>(effects::WaveFeatures::sampleRateHz);
    const uint32_t rateHz = sampleRateHz != 0 ? sampleRateHz : featureHz;
    const uint32_t factor = rateHz / featureHz;
    if (factor == 0 || factor > effects::WaveDecimation::maximumFactor || rateHz % featureHz != 0) {
        throw std::invalid_argument("options: sample_rate_hz is " + std::to_string(sampleRateHz) +
                                    "; expected a multiple of 2000 up to 192000, or 0 for 2000");
    }
    return factor;
}

struct OpenWaveFeatures {
    OpenWaveFeatures(const effects::WaveFeatureOptions& options, std::size_t factor)
        : features(options), decimation(factor) {}

    std::mutex mutex;
    effects::WaveFeatures features;
    effects::WaveDecimation decimation;
};

}  // namespace haptoflow::capi

namespace {

effects::WaveFeatureOptions featureOptions(const haptoflow_wave_features_options& given) {
    effects::WaveFeatureOptions options;
    const auto take = [](double& target, double value) { target = value != 0.0 ? value : target; };
    take(options.frameSeconds, given.frame_seconds);
    take(options.minFrequencyHz, given.minimum_frequency_hz);
    take(options.maxFrequencyHz, given.maximum_frequency_hz);
    return options;
}

haptoflow_wave_frame frameOf(const effects::WaveFrame& frame) {
    return {.first_sample = frame.firstSample,
            .sample_count = frame.sampleCount,
            .intensity = frame.intensity,
            .centroid_hz = frame.centroidHz,
            .frequency_hz = frame.frequencyHz,
            .amplitude_mps2 = frame.amplitudeMps2,
            .transient_offset_seconds = frame.transient.offsetSeconds,
            .transient_amplitude_mps2 = frame.transient.amplitudeMps2,
            .transient_frequency_hz = frame.transient.frequencyHz};
}

}  // namespace

haptoflow_status haptoflow_wave_features_create(const haptoflow_wave_features_options* options,
                                                haptoflow_wave_features** features) {
    return guarded([&] {
        const auto given = readDescriptor(options, "options");
        (void)require(features, "features");
        *features = waveFeatures().open(
            std::make_shared<OpenWaveFeatures>(featureOptions(given), decimationOf(given.sample_rate_hz)));
    });
}

haptoflow_status haptoflow_wave_features_close(haptoflow_wave_features** features) {
    return guarded([&] { closeHandle(waveFeatures(), features, "features"); });
}

haptoflow_status haptoflow_wave_features_reset(haptoflow_wave_features* features) {
    return guarded([&] {
        const auto open = waveFeatures().get(features);
        const std::lock_guard lock(open->mutex);
        open->features.reset();
        open->decimation.reset();
    });
}

haptoflow_status haptoflow_wave_features_set_range(haptoflow_wave_features* features, double minimum_frequency_hz,
                                                   double maximum_frequency_hz) {
    return guarded([&] {
        if (!(minimum_frequency_hz > 0.0 && minimum_frequency_hz <= maximum_frequency_hz &&
              maximum_frequency_hz <= 1000.0)) {
            throw std::invalid_argument("the range is " + std::to_string(minimum_frequency_hz) + " to " +
                                        std::to_string(maximum_frequency_hz) + " Hz; expected above 0 to 1000");
        }
        const auto open = waveFeatures().get(features);
        const std::lock_guard lock(open->mutex);
        open->features.setDeviceRange(minimum_frequency_hz, maximum_frequency_hz);
    });
}

haptoflow_status haptoflow_wave_features_process(haptoflow_wave_features* features, const float* wave_mps2,
                                                 uint64_t sample_count, haptoflow_wave_frame* frames, uint64_t capacity,
                                                 uint64_t* frame_count) {
    return guarded([&] {
        (void)require(frame_count, "frame_count");
        if (sample_count > 0) {
            (void)require(wave_mps2, "wave_mps2");
        }
        if (capacity > 0) {
            (void)require(frames, "frames");
        }
        const auto open = waveFeatures().get(features);
        const std::lock_guard lock(open->mutex);
        uint64_t written = 0;
        for (uint64_t i = 0; i < sample_count; ++i) {
            float decimated = 0.0F;
            if (!open->decimation.take(wave_mps2[i], decimated)) {
                continue;
            }
            // A frame is longer than a sample, so that one sample completes at most one frame.
            effects::WaveFrame frame;
            const auto progress = open->features.process(std::span(&decimated, 1), std::span(&frame, 1));
            if (progress.frames > 0 && written < capacity) {
                frames[written++] = frameOf(frame);
            }
        }
        *frame_count = written;
    });
}
