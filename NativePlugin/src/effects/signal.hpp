#pragma once

#include "dsp/gate.hpp"
#include "dsp/level_smoother.hpp"
#include "effects/effect.hpp"

#include <span>

namespace haptoflow::effects {

/// A sine for studies, which stands for the texture; an amplitude of 0 is none.
struct SignalSettings {
    static constexpr double lowestHz = 20.0;
    static constexpr double highestHz = 500.0;
    static constexpr double largestMps2 = 60.0;

    float frequencyHz = 0.0F;
    /// Peak.
    float amplitudeMps2 = 0.0F;

    [[nodiscard]] bool isSet() const noexcept { return amplitudeMps2 > 0.0F; }
};

/// A source of a sine that is switched on and off: each within 2 ms on a raised cosine, and turned round at any sample
/// without a step. The phase begins at 0 out of silence and goes on for as long as anything sounds, whatever changes.
/// Audio thread but for construction.
class Signal final : public Effect {
public:
    static constexpr double rampSeconds = 0.002;

    /// Throws std::invalid_argument for a rate that Gate refuses.
    explicit Signal(double sampleRateHz);

    /// The frequency changes with the next sample, the amplitude within 10 ms; at once while nothing sounds. Settings
    /// that are not set change nothing: what sounds ends as it was. May be called before every block.
    void set(const SignalSettings& settings) noexcept;
    /// From the next sample on.
    void begin() noexcept;
    void end() noexcept { gate_.close(); }
    /// True from `begin` until `end` or `reset`.
    [[nodiscard]] bool isOn() const noexcept { return gate_.isOpening(); }

    [[nodiscard]] EffectDeclaration declaration() const noexcept override;
    void process(std::span<float> samplesMps2) noexcept override;
    void reset() noexcept override;
    [[nodiscard]] bool isIdle() const noexcept override { return gate_.isClosed(); }

private:
    double sampleRateHz_;
    dsp::Gate gate_;
    dsp::LevelSmoother amplitudeMps2_;
    float frequencyHz_ = 0.0F;
    // The phase as a point on the unit circle, and what turns it by one sample.
    double cosine_ = 1.0;
    double sine_ = 0.0;
    double turnCosine_ = 1.0;
    double turnSine_ = 0.0;
};

}  // namespace haptoflow::effects
