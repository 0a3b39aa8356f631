#pragma once

#include "dsp/gate.hpp"
#include "dsp/level_smoother.hpp"
#include "dsp/waveform_resampler.hpp"
#include "engine/effect_stage.hpp"

namespace haptoflow::engine {

/// The parts of a voice that depend on the output rate. Construction allocates, so another thread than the callback's
/// makes one for each new rate.
struct OutputStage {
    /// Throws std::invalid_argument for a rate outside 8-192 kHz.
    explicit OutputStage(double outputRateHz)
        : rateHz(outputRateHz),
          resampler(outputRateHz),
          gate(outputRateHz),
          effects(outputRateHz),
          strength(outputRateHz) {}

    double rateHz;
    dsp::WaveformResampler resampler;
    /// Gate of the texture only.
    dsp::Gate gate;
    EffectStage effects;
    dsp::LevelSmoother strength;
};

}  // namespace haptoflow::engine
