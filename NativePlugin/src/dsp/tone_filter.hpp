#pragma once

#include "dsp/tone_cepstrum.hpp"

#include <array>
#include <cstddef>
#include <span>

namespace haptoflow::dsp {

/// Applies a tone to a waveform at 2 kHz. Another kernel takes over within 10 ms, in a straight line from tap to tap.
/// Without a tone nothing runs. Allocates nothing, waits for nothing; audio thread.
class ToneFilter {
public:
    static constexpr std::size_t memorySamples = toneTaps - 1;
    static constexpr std::size_t fadeSamples = 20;

    /// Null for no tone. Glides there while `past` is what has just been played: its newest samples, of which the
    /// filter's memory is made where it has not been running.
    void setTone(const ToneKernel* kernel, std::span<const float, memorySamples> past) noexcept;
    /// The same at once, for a waveform that begins anew; the memory is silence.
    void reset(const ToneKernel* kernel) noexcept;

    /// False where `process` would change nothing.
    [[nodiscard]] bool isActive() const noexcept { return active_; }
    /// Whether `kernel` is what the filter is, or is gliding to.
    [[nodiscard]] bool isHeadingFor(const ToneKernel* kernel) const noexcept;
    void process(std::span<float> samples) noexcept;

private:
    void settle() noexcept;

    bool active_ = false;
    /// Whether what it heads for is a tone at all.
    bool hasTone_ = false;
    ToneKernel from_{};
    ToneKernel to_{};
    std::size_t fadeLeft_ = 0;
    /// The newest first.
    std::array<float, memorySamples> memory_{};
};

}  // namespace haptoflow::dsp
