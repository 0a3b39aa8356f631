#pragma once

#include <cstdint>
#include <span>

namespace haptoflow::dsp {

/// A gain that moves to its target in a straight line; each change states its own length. Audio thread: allocates
/// nothing, waits for nothing.
class GainRamp {
public:
    explicit GainRamp(float gain = 0.0F) noexcept : value_(gain), target_(gain) {}

    /// Reaches `gain` exactly with the last of the next `samples` samples (at least 1).
    void moveTo(float gain, std::uint32_t samples) noexcept {
        target_ = gain;
        remaining_ = samples;
        step_ = (static_cast<double>(gain) - value_) / static_cast<double>(samples);
    }
    /// Takes the value `gain` at once.
    void jumpTo(float gain) noexcept {
        target_ = gain;
        value_ = gain;
        remaining_ = 0;
    }
    /// Advances by one sample and returns its gain.
    [[nodiscard]] float next() noexcept {
        if (remaining_ > 0) {
            --remaining_;
            value_ = remaining_ == 0 ? static_cast<double>(target_) : value_ + step_;
        }
        return static_cast<float>(value_);
    }

    [[nodiscard]] float target() const noexcept { return target_; }
    [[nodiscard]] bool isSettled() const noexcept { return remaining_ == 0; }
    [[nodiscard]] bool isSettledAt(float gain) const noexcept { return isSettled() && target_ == gain; }

private:
    double value_;
    double step_ = 0.0;
    float target_;
    std::uint32_t remaining_ = 0;
};

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

/// Opens within 2 ms and closes within `closeSeconds` along a raised cosine. It can change direction at any sample
/// without a step. A closed gate outputs exact zeros for any input, an open one passes the signal unchanged. To change
/// direction inside a block, process the samples before the change first. Audio thread: allocates nothing, waits for
/// nothing.
class Gate {
public:
    static constexpr double defaultCloseSeconds = 0.005;

    /// Starts closed. `closeSeconds` is above 0. Throws std::invalid_argument unless `sampleRateHz` is the waveform
    /// rate or an output rate.
    explicit Gate(double sampleRateHz, double closeSeconds = defaultCloseSeconds);

    /// Starts opening with the next sample.
    void open() noexcept { opening_ = true; }
    /// Starts closing: the next sample is already attenuated, and the output is silent within `closeSeconds`.
    void close() noexcept { opening_ = false; }
    /// Closes at once, without a ramp: for a new stream.
    void reset() noexcept;
    /// Opens fully at once, without a ramp: for a signal that starts at zero by itself.
    void openAtOnce() noexcept;

    [[nodiscard]] bool isOpening() const noexcept { return opening_; }
    /// True once the output is silent, until the next `open`.
    [[nodiscard]] bool isClosed() const noexcept { return !opening_ && position_ == 0; }
    /// Advances by one sample and returns its gain in [0, 1].
    [[nodiscard]] float nextGain() noexcept;
    /// Applies the gate in place.
    void process(std::span<float> samples) noexcept;

private:
    [[nodiscard]] std::uint64_t fullyOpen() const noexcept { return openSamples_ * closeSamples_; }

    // Computed before the audio thread uses it.
    std::span<const float> curve_;
    std::uint64_t openSamples_;
    std::uint64_t closeSamples_;
    // In units of 1 / (open samples * close samples). An integer, so that both ramps end exactly, whatever the changes
    // of direction.
    std::uint64_t position_ = 0;
    bool opening_ = false;
};

}  // namespace haptoflow::dsp
