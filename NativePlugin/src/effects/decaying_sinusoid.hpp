#pragma once

#include "effects/effect.hpp"

#include <span>

namespace haptoflow::effects {

/// One ringing mode: amplitude e^(-decay t) sin(2 pi frequency t), by a recursion of two multiplications a sample.
/// Audio thread: allocates nothing, waits for nothing.
class DecayingSinusoid {
public:

    /// Rings from the next sample on, whatever rang before. Frequencies beyond 0.45 of the rate, and anything that is
    /// not finite or not above 0, ring not at all.
    void start(double frequencyHz, double decayPerSecond, double amplitudeMps2, double sampleRateHz) noexcept;
    void stop() noexcept { *this = DecayingSinusoid(); }
    /// Adds the next samples.
    void addTo(std::span<float> samplesMps2) noexcept;

    [[nodiscard]] bool isIdle() const noexcept { return envelopeMps2_ < imperceptibleMps2; }
    /// What its amplitude has decayed to.
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
