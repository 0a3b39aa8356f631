#pragma once

#include "dsp/gain_ramp.hpp"

#include <cstdint>
#include <span>

namespace haptoflow::dsp {

/// A gain that takes the same time for every change, so that no change of strength or level clicks. Audio thread:
/// allocates nothing, waits for nothing. Another thread sets a target through an atomic, which the audio thread reads
/// once a block and passes to `setTarget`.
class LevelSmoother {
public:
    /// Throws std::invalid_argument unless `sampleRateHz` is the waveform rate or an output rate, `rampSeconds` is 0-1
    /// and `initialGain` is finite.
    explicit LevelSmoother(double sampleRateHz, double rampSeconds = 0.01, float initialGain = 1.0F);

    /// Starts a ramp that reaches `gain` after one ramp time. Ignores a non-finite gain and the present target.
    void setTarget(float gain) noexcept;
    /// Takes the value `gain` at once, for a new stream. Ignores a non-finite gain.
    void reset(float gain) noexcept;
    [[nodiscard]] float target() const noexcept { return ramp_.target(); }
    [[nodiscard]] bool isSettled() const noexcept { return ramp_.isSettled(); }
    /// Advances by one sample and returns its gain. The last gain of a ramp is exactly the target.
    [[nodiscard]] float next() noexcept { return ramp_.next(); }
    /// Multiplies in place. A settled gain of 1 leaves every sample unchanged.
    void process(std::span<float> samples) noexcept;

private:
    std::uint32_t rampSamples_;
    GainRamp ramp_;
};

}  // namespace haptoflow::dsp
