#pragma once

#include "dsp/gate.hpp"
#include "effects/effect.hpp"

#include <span>

namespace haptoflow::effects {

/// A sinusoid for studies, played instead of the texture. An amplitude of 0 means no signal.
struct SignalSettings {
    static constexpr double minimumHz = 20.0;
    static constexpr double maximumHz = 500.0;
    static constexpr double maximumMps2 = 60.0;

    float frequencyHz = 0.0F;
    /// Peak amplitude.
    float amplitudeMps2 = 0.0F;

    [[nodiscard]] bool isSet() const noexcept { return amplitudeMps2 > 0.0F; }
};

/// A sinusoid that can be switched on and off. Each change takes 2 ms along a raised cosine and can be reversed at any
/// sample without a step. The phase starts at 0 from silence and is continuous while the signal sounds. Construction
/// excepted, everything runs on the audio thread.
class Signal final : public Effect {
public:
    static constexpr double rampSeconds = 0.002;

    /// Throws std::invalid_argument for a rate outside 8-192 kHz.
    explicit Signal(double sampleRateHz);

    /// The frequency changes with the next sample, the amplitude within 10 ms, or at once while the signal is silent.
    /// Settings with an amplitude of 0 are ignored, so that a sounding signal ends with its own settings. May be called
    /// before every block.
    void set(const SignalSettings& settings) noexcept;
    /// Both take effect with the next sample.
    void begin() noexcept;
    void end() noexcept { gate_.close(); }
    /// True from `begin` until `end` or `reset`.
    [[nodiscard]] bool isOn() const noexcept { return gate_.isOpening(); }

    void process(std::span<float> samplesMps2) noexcept override;
    void reset() noexcept override;
    [[nodiscard]] bool isIdle() const noexcept override { return gate_.isClosed(); }

private:
    double sampleRateHz_;
    dsp::Gate gate_;
    dsp::LevelSmoother amplitudeMps2_;
    float frequencyHz_ = 0.0F;
    // The phase as a point on the unit circle, and the rotation per sample.
    double cosine_ = 1.0;
    double sine_ = 0.0;
    double turnCosine_ = 1.0;
    double turnSine_ = 0.0;
};

}  // namespace haptoflow::effects
