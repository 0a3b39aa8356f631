#include "parametric_frames.hpp"

#include "effects/carrier_rendering.hpp"
#include "effects/device_loudness.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>

namespace haptoflow::cli {
namespace {

using effects::WaveDecimation;
using effects::WaveFeatures;

const effects::WaveFeatureOptions& options() {
    static const effects::WaveFeatureOptions usual;
    return usual;
}

/// Time in the render, in seconds, of a sample of the features, with the delay of the decimation subtracted.
double secondsAt(std::uint64_t sample) {
    constexpr auto delay = static_cast<double>(WaveDecimation::delaySamples);
    return std::max(0.0, (static_cast<double>(sample) - delay) / WaveFeatures::sampleRateHz);
}

/// The part of the device's range that a controller plays by the loudness law.
float shareOf(float amplitudeMps2) {
    return effects::deviceShare(effects::DeviceKind::parametric, amplitudeMps2);
}

nlohmann::ordered_json errorOf(std::span<const float> wave, std::span<const effects::WaveFrame> frames,
                               const effects::WaveFeatureOptions& cut, effects::CarrierShape shape) {
    const std::vector<float> played = effects::renderCarrier(frames, {.shape = shape});
    const auto summary = effects::summarise(effects::intensityErrors(wave, played, cut));
    return {{"felt_frames", summary.feltFrames},
            {"mean", summary.meanDb},
            {"mean_magnitude", summary.meanMagnitudeDb},
            {"p95", summary.percentile95Db}};
}

/// Errors of the played intensity.
nlohmann::ordered_json intensityErrors(std::span<const float> wave, std::span<const effects::WaveFrame> frames) {
    effects::WaveFeatureOptions motor;
    motor.frameSeconds = 0.008;
    motor.minFrequencyHz = 160.0;
    motor.maxFrequencyHz = 160.0;
    return {{"frames", errorOf(wave, frames, options(), effects::CarrierShape::linear)},
            {"motor_160_hz", errorOf(wave, effects::framesOf(wave, motor), motor, effects::CarrierShape::held)}};
}

}  // namespace

ParametricFrames::ParametricFrames(double outputRateHz)
    : decimation_(static_cast<std::size_t>(outputRateHz / WaveFeatures::sampleRateHz)), features_(options()) {}

void ParametricFrames::take(std::span<const float> samples, float fullScaleMps2) {
    for (const float sample : samples) {
        float decimated = 0.0F;
        if (decimation_.take(sample * fullScaleMps2, decimated)) {
            feed(decimated);
        }
    }
}

void ParametricFrames::feed(float sampleMps2) {
    wave_.push_back(sampleMps2);
    effects::WaveFrame frame;
    const auto progress = features_.process(std::span(&sampleMps2, 1), std::span(&frame, 1));
    if (progress.frames > 0) {
        frames_.push_back(frame);
    }
}

std::string ParametricFrames::toJson() {
    // The last frame is complete only some samples after its end.
    for (std::size_t i = 0; i < WaveFeatures::lookaheadSamples + WaveDecimation::delaySamples; ++i) {
        feed(0.0F);
    }
    nlohmann::ordered_json frames = nlohmann::ordered_json::array();
    nlohmann::ordered_json transients = nlohmann::ordered_json::array();
    for (const effects::WaveFrame& frame : frames_) {
        const double seconds = secondsAt(frame.firstSample);
        frames.push_back(
            {seconds, frame.amplitudeMps2, frame.frequencyHz, frame.intensity, shareOf(frame.amplitudeMps2)});
        if (frame.transient.amplitudeMps2 > 0.0F) {
            transients.push_back({seconds + static_cast<double>(frame.transient.offsetSeconds),
                                  frame.transient.amplitudeMps2, frame.transient.frequencyHz,
                                  shareOf(frame.transient.amplitudeMps2)});
        }
    }
    const nlohmann::ordered_json document{
        {"format", "haptoflow parametric"},
        {"version", 1},
        {"frame_seconds", options().frameSeconds},
        {"frequency_range_hz", {options().minFrequencyHz, options().maxFrequencyHz}},
        {"frame_columns", {"seconds", "amplitude_mps2", "frequency_hz", "intensity", "device_share"}},
        {"frames", std::move(frames)},
        {"transient_columns", {"seconds", "amplitude_mps2", "frequency_hz", "device_share"}},
        {"transients", std::move(transients)},
        {"intensity_error_db", intensityErrors(wave_, frames_)},
    };
    return document.dump() + '\n';
}

}  // namespace haptoflow::cli
