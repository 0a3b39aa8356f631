#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace haptoflow::dsp {

/// Reads a 2 kHz waveform at any output rate from 8 to 192 kHz: polyphase, minimum-phase Kaiser design.
///
/// Passband 0-900 Hz within 0.1 dB, images (above 1,100 Hz) below -80 dB; both scale with the input rate.
/// Group delay 1.2 ms to 200 Hz, 1.5 ms at 500, 2.6 ms at 800, 4.1 ms at 900 Hz: the same magnitude in linear phase
/// would delay everything by 13.5 ms.
/// The phase is an integer fraction, so that the read position is exact however long the stream runs. A rate is taken
/// to the nearest 2^-20 Hz.
/// Look-ahead is nil: output at time t uses input up to t, and all input consumed is sounding or past.
class WaveformResampler {
public:
    /// Not on the audio thread: designs and allocates. To change rates, build a new one and swap it in.
    /// Throws std::invalid_argument for an output rate outside 8-192 kHz or an input rate outside 500-8,000 Hz.
    explicit WaveformResampler(double outputRateHz, double inputRateHz = 2000.0);

    /// By how many input samples the output lags, at low frequencies, rounded: 2. Any thread.
    [[nodiscard]] std::size_t latencyInputSamples() const noexcept { return latencyInputSamples_; }
    /// Group delay in seconds at `frequencyHz` (0 to 0.45 of the input rate). Sums the whole kernel: not for the
    /// audio thread.
    [[nodiscard]] double groupDelaySeconds(double frequencyHz) const noexcept;
    /// How many input samples the next `process` of `outputCount` (below 2^32) samples will consume. Audio thread.
    [[nodiscard]] std::size_t inputNeeded(std::size_t outputCount) const noexcept;
    /// `input` holds exactly inputNeeded(output.size()) samples; missing ones count as 0, surplus ones are ignored.
    /// Audio thread: allocates nothing, waits for nothing. Output does not depend on how it is cut into blocks.
    void process(std::span<const float> input, std::span<float> output) noexcept;
    /// Forgets the past: the next output rises from silence.
    void reset() noexcept;
    /// Starts anew as if `past` (its newest 56 samples count, oldest first) had just been consumed: the next output
    /// goes on from it. Costs one copy, however far the output rate is from the input's.
    void prime(std::span<const float> past) noexcept;

private:
    void push(float sample) noexcept;
    [[nodiscard]] float interpolate() const noexcept;

    double inputRateHz_;
    std::size_t latencyInputSamples_;
    std::uint64_t step_;  // input samples per output sample = step_ / period_
    std::uint64_t period_;
    std::uint64_t fraction_;  // of an input sample past the newest one, in 1 / period_
    std::size_t phases_;
    bool exactPhases_;
    std::vector<float> taps_;     // rows of one phase each, oldest sample first
    std::vector<float> history_;  // every sample twice, one kernel length apart: any window is contiguous
    std::size_t writeIndex_ = 0;
};

}  // namespace haptoflow::dsp
