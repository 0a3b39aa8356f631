#pragma once

#include <cstdint>

namespace haptoflow::unity {

/// A gain that moves in straight lines of any length, so that a fade fits into the block it has to end in. Audio
/// thread: allocates nothing, waits for nothing.
class GainRamp {
public:
    /// Arrives at `gain` exactly, with the last of so many frames (at least 1) from now.
    void head(float gain, std::uint32_t frames) noexcept {
        target_ = gain;
        framesLeft_ = frames;
        step_ = (static_cast<double>(gain) - value_) / static_cast<double>(frames);
    }
    void jump(float gain) noexcept {
        target_ = gain;
        value_ = gain;
        framesLeft_ = 0;
    }
    [[nodiscard]] float next() noexcept {
        if (framesLeft_ > 0) {
            --framesLeft_;
            value_ = framesLeft_ == 0 ? static_cast<double>(target_) : value_ + step_;
        }
        return static_cast<float>(value_);
    }

    [[nodiscard]] float target() const noexcept { return target_; }
    [[nodiscard]] bool isSettledAt(float gain) const noexcept { return framesLeft_ == 0 && target_ == gain; }

private:
    double value_ = 0.0;
    double step_ = 0.0;
    float target_ = 0.0F;
    std::uint32_t framesLeft_ = 0;
};

}  // namespace haptoflow::unity
