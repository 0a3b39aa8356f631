#pragma once

#include "dsp/gate.hpp"
#include "dsp/level_smoother.hpp"
#include "dsp/waveform_resampler.hpp"
#include "engine/effect_stage.hpp"

namespace haptoflow::engine {

/// What a voice needs for one output rate. It allocates when it is made, so a new rate brings a new one, made
/// elsewhere than in the callback.
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
    /// Of the texture alone.
    dsp::Gate gate;
    EffectStage effects;
    dsp::LevelSmoother strength;
};

}  // namespace haptoflow::engine
