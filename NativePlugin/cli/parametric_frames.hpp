#pragma once

#include "effects/wave_decimation.hpp"
#include "effects/wave_features.hpp"

#include <span>
#include <string>
#include <vector>

namespace haptoflow::cli {

/// Collects what a device with one carrier gets for a render, frame by frame.
class ParametricFrames {
public:
    /// Of the output: a multiple of 2000 Hz. Throws std::invalid_argument.
    explicit ParametricFrames(double outputRateHz);

    /// The next samples, +-1 for `fullScaleMps2`.
    void take(std::span<const float> samples, float fullScaleMps2);
    /// The layout is described in Documentation~/effects-and-outputs.md.
    [[nodiscard]] std::string toJson();

private:
    void feed(float sampleMps2);

    effects::WaveDecimation decimation_;
    effects::WaveFeatures features_;
    std::vector<effects::WaveFrame> frames_;
    // At 2 kHz: what was wanted, for the error of what is played.
    std::vector<float> wave_;
};

}  // namespace haptoflow::cli
