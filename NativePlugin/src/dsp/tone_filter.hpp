#pragma once

#include "dsp/tone_cepstrum.hpp"

#include <array>
#include <cstddef>
#include <span>

namespace haptoflow::dsp {

/// Applies a tone to a waveform at 2 kHz. A change of kernel takes 10 ms, during which each tap moves linearly. Without
/// a tone the filter does not run. Audio thread: allocates nothing, waits for nothing.
class ToneFilter {
public:
    static constexpr std::size_t memorySamples = toneTaps - 1;
    static constexpr std::size_t fadeSamples = 20;

    /// Starts the change to `kernel` (null for no tone). `past` holds the samples played last; they fill the filter's
    /// memory if it was not running.
    void setTone(const ToneKernel* kernel, std::span<const float, memorySamples> past) noexcept;
    /// Changes to `kernel` at once and clears the memory, for a new waveform.
    void reset(const ToneKernel* kernel) noexcept;

    /// False if `process` would change nothing.
    [[nodiscard]] bool isActive() const noexcept { return active_; }
    /// Whether the filter has `kernel` or is changing to it.
    [[nodiscard]] bool isTarget(const ToneKernel* kernel) const noexcept;
    void process(std::span<float> samples) noexcept;

private:
    void settle() noexcept;

    bool active_ = false;
    /// Whether the target is a tone.
    bool hasTone_ = false;
    ToneKernel from_{};
    ToneKernel to_{};
    std::size_t fadeRemaining_ = 0;
    /// Past input samples, the newest first.
    std::array<float, memorySamples> memory_{};
};

}  // namespace haptoflow::dsp
