#include "web_imports.hpp"
#include "web_text.hpp"

#include "haptoflow/haptoflow.h"

#include <array>
#include <cstddef>

using namespace haptoflow::web;

// Points for motors: the wave as it is played, cut into frames of equal perceived intensity.

HAPTO_EXPORT HAPTO_NAMED("hapto_motor_create") haptoflow_wave_features* hapto_motor_create(double rateHz,
                                                                                           double frameSeconds,
                                                                                           double minimumHz,
                                                                                           double maximumHz) {
    haptoflow_wave_features* features = nullptr;
    (void)guarded([&] {
        haptoflow_wave_features_options options{};
        options.struct_size = sizeof(options);
        options.sample_rate_hz = static_cast<uint32_t>(rateHz);
        options.frame_seconds = frameSeconds;
        options.minimum_frequency_hz = minimumHz;
        options.maximum_frequency_hz = maximumHz;
        require(haptoflow_wave_features_create(&options, &features));
        return 0;
    });
    return features;
}

HAPTO_EXPORT HAPTO_NAMED("hapto_motor_close") void hapto_motor_close(haptoflow_wave_features* features) {
    (void)haptoflow_wave_features_close(&features);
}

/// Processes samples in m/s^2 and writes, for each frame that they complete, its first sample (at 2 kHz), its length,
/// the carrier's amplitude and frequency, its share of a motor's range, and the share and time of its onset. Returns
/// the number of frames, `capacity` at most.
HAPTO_EXPORT HAPTO_NAMED("hapto_motor_process") int hapto_motor_process(haptoflow_wave_features* features,
                                                                        const float* samplesMps2, std::uint32_t count,
                                                                        double* points, int capacity) {
    return guarded([&] {
        constexpr std::size_t frameCount = 64;
        std::array<haptoflow_wave_frame, frameCount> frames{};
        uint64_t found = 0;
        require(haptoflow_wave_features_process(features, samplesMps2, count, frames.data(), frames.size(), &found));
        const auto kept = std::min<std::size_t>(
            {static_cast<std::size_t>(found), frames.size(), static_cast<std::size_t>(std::max(capacity, 0))});
        for (std::size_t index = 0; index < kept; ++index) {
            const haptoflow_wave_frame& frame = frames[index];
            float share = 0.0F;
            float transientShare = 0.0F;
            require(haptoflow_device_share(HAPTOFLOW_DEVICE_MOTOR, frame.amplitude_mps2, &share));
            require(haptoflow_device_share(HAPTOFLOW_DEVICE_MOTOR, frame.transient_amplitude_mps2, &transientShare));
            const double values[] = {static_cast<double>(frame.first_sample),
                                     static_cast<double>(frame.sample_count),
                                     static_cast<double>(frame.amplitude_mps2),
                                     static_cast<double>(frame.frequency_hz),
                                     static_cast<double>(share),
                                     static_cast<double>(transientShare),
                                     static_cast<double>(frame.transient_offset_seconds)};
            points = std::copy(std::begin(values), std::end(values), points);
        }
        return static_cast<int>(kept);
    });
}
