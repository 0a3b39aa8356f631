#pragma once

#include "effects/effect.hpp"

#include <span>

namespace haptoflow::effects {

/// One vibration mode, amplitude e^(-decay t) sin(2 pi frequency t), computed by a recursion with two multiplications
/// per sample. Audio thread: allocates nothing, waits for nothing.
class DecayingSinusoid {
public:
    /// Replaces the present sinusoid from the next sample on. A frequency above 0.45 of the rate, or an argument that
    /// is not finite and above 0, gives silence.
    void start(double frequencyHz, double decayPerSecond, double amplitudeMps2, double sampleRateHz) noexcept;
    void stop() noexcept { *this = DecayingSinusoid(); }
    /// Adds the next samples of the sinusoid to `samplesMps2`.
    void addTo(std::span<float> samplesMps2) noexcept;

    [[nodiscard]] bool isIdle() const noexcept { return envelopeMps2_ < imperceptibleMps2; }
    /// The present amplitude of the decaying envelope.
    [[nodiscard]] double envelopeMps2() const noexcept { return envelopeMps2_; }

private:
    double newest_ = 0.0;
    double previous_ = 0.0;
    double feedback_ = 0.0;
    double damping_ = 0.0;
    double decay_ = 0.0;
    double envelopeMps2_ = 0.0;
};

}  // namespace haptoflow::effects
