#pragma once

#include <cstdint>

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

}  // namespace haptoflow::dsp
