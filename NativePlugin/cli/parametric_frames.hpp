#pragma once

#include "effects/wave_features.hpp"

#include <span>
#include <string>
#include <vector>

namespace haptoflow::cli {

/// Collects the frames that a device with one carrier gets for a render.
class ParametricFrames {
public:
    /// `outputRateHz`: a multiple of 2000 Hz. Throws std::invalid_argument.
    explicit ParametricFrames(double outputRateHz);

    /// Processes the next samples, +-1 at `fullScaleMps2`.
    void take(std::span<const float> samples, float fullScaleMps2);
    /// The frames as JSON; Documentation~/effects-and-outputs.md describes the format.
    [[nodiscard]] std::string toJson();

private:
    void feed(float sampleMps2);

    effects::WaveDecimation decimation_;
    effects::WaveFeatures features_;
    std::vector<effects::WaveFrame> frames_;
    // The wave at 2 kHz, for the errors of the played intensity.
    std::vector<float> wave_;
};

}  // namespace haptoflow::cli
