#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace haptoflow::dsp {

/// Reads a 2 kHz waveform at any output rate from 8 to 192 kHz: a polyphase windowed-sinc interpolator with a
/// double-precision phase that cannot drift. Audio thread: `process` allocates nothing and is bounded.
class WaveformResampler {
public:
    /// Passband 0-900 Hz within 0.1 dB, images below -80 dB. Throws std::invalid_argument outside 8-192 kHz.
    explicit WaveformResampler(double outputRateHz, double inputRateHz = 2000.0);

    /// Half length of the kernel, in input samples: the output lags the input by this much.
    [[nodiscard]] std::size_t latencyInputSamples() const noexcept;
    /// How many input samples the next `process` of `outputCount` samples will consume.
    [[nodiscard]] std::size_t inputNeeded(std::size_t outputCount) const noexcept;
    /// `input` must hold exactly inputNeeded(output.size()) samples.
    void process(std::span<const float> input, std::span<float> output) noexcept;
    /// Forgets the past: the next output rises from silence.
    void reset() noexcept;

private:
    struct Kernel;
    std::vector<float> taps_;
    std::vector<float> history_;
};

}  // namespace haptoflow::dsp
