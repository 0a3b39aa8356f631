#include "capi/handles.hpp"
#include "effects/device_loudness.hpp"

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
    explicit OpenDeviceWave(double sampleRateHz) : wave(sampleRateHz) {}

    std::mutex mutex;
    effects::DeviceWave wave;
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
