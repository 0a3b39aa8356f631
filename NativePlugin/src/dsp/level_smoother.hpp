#pragma once

#include <cstddef>
#include <span>

namespace haptoflow::dsp {

/// A gain that moves to its target in a straight line, so that no change of strength or level is heard as a click.
/// All on the audio thread: allocates nothing, waits for nothing. A target that comes from another thread is read
/// from its atomic once a block and handed over here.
class LevelSmoother {
public:
    /// Throws std::invalid_argument unless `sampleRateHz` is above 0, `rampSeconds` is 0-1 and `initialGain` is finite.
    explicit LevelSmoother(double sampleRateHz, double rampSeconds = 0.01, float initialGain = 1.0F);

    /// Heads for `gain`, to arrive one ramp time from now; a non-finite one is ignored. Setting the target it already
    /// heads for changes nothing.
    void setTarget(float gain) noexcept;
    /// Takes on `gain` at once, for a stream that starts anew; a non-finite one is ignored.
    void reset(float gain) noexcept;
    [[nodiscard]] float target() const noexcept { return target_; }
    [[nodiscard]] bool isSettled() const noexcept { return remaining_ == 0; }
    /// Advances by one sample and returns its gain. Arrives exactly.
    [[nodiscard]] float next() noexcept;
    /// Multiplies in place; a settled gain of 1 leaves the samples as they are.
    void process(std::span<float> samples) noexcept;

private:
    std::size_t rampSamples_;
    std::size_t remaining_ = 0;
    double current_;
    double step_ = 0.0;
    float target_;
};

}  // namespace haptoflow::dsp
