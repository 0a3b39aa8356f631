#include "parametric_frames.hpp"

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

/// Seconds of the render at a sample of the features, without what the decimation delays.
double secondsAt(std::uint64_t sample) {
    constexpr auto delay = static_cast<double>(WaveDecimation::delaySamples);
    return std::max(0.0, (static_cast<double>(sample) - delay) / WaveFeatures::sampleRateHz);
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
        frames.push_back({seconds, frame.amplitudeMps2, frame.frequencyHz, frame.intensity});
        if (frame.transient.amplitudeMps2 > 0.0F) {
            transients.push_back({seconds + static_cast<double>(frame.transient.offsetSeconds),
                                  frame.transient.amplitudeMps2, frame.transient.frequencyHz});
        }
    }
    const nlohmann::ordered_json document{
        {"format", "haptoflow parametric"},
        {"version", 1},
        {"frame_seconds", options().frameSeconds},
        {"frequency_range_hz", {options().minFrequencyHz, options().maxFrequencyHz}},
        {"frame_columns", {"seconds", "amplitude_mps2", "frequency_hz", "intensity"}},
        {"frames", std::move(frames)},
        {"transient_columns", {"seconds", "amplitude_mps2", "frequency_hz"}},
        {"transients", std::move(transients)},
    };
    return document.dump() + '\n';
}

}  // namespace haptoflow::cli
