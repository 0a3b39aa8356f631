#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace haptoflow::dsp {

/// Converts a 2 kHz waveform to an output rate from 8 to 192 kHz with a polyphase, minimum-phase Kaiser filter.
///
/// The passband, 0-900 Hz, is flat within 0.1 dB; images (above 1,100 Hz) are below -80 dB. The group delay is 1.2 ms
/// up to 200 Hz, 1.5 ms at 500 Hz, 2.6 ms at 800 Hz and 4.1 ms at 900 Hz; a linear-phase filter of the same magnitude
/// would delay everything by 13.5 ms. The phase is an integer fraction, so the read position stays exact however long
/// the stream runs; rates are rounded to 2^-20 Hz. There is no look-ahead: the output at time t depends on input up to
/// t only.
class WaveformResampler {
public:
    /// Designs the filter and allocates: not on the audio thread. To change the rate, build a new resampler and swap it
    /// in. Throws std::invalid_argument for an output rate outside 8-192 kHz.
    explicit WaveformResampler(double outputRateHz);

    /// Delay at low frequencies, rounded to input samples: 2. Any thread.
    [[nodiscard]] std::size_t latencyInputSamples() const noexcept { return latencyInputSamples_; }
    /// Group delay in seconds at `frequencyHz` (0 to 900 Hz). Sums over the whole kernel: not on the audio thread.
    [[nodiscard]] double groupDelaySeconds(double frequencyHz) const noexcept;
    /// Number of input samples that the next `process` of `outputCount` (below 2^32) samples consumes. Audio thread.
    [[nodiscard]] std::size_t inputNeeded(std::size_t outputCount) const noexcept;
    /// From the next output sample to the next input sample that is consumed, in input samples: 0 to 1. Audio thread.
    [[nodiscard]] double samplesUntilNext() const noexcept;
    /// `input` holds inputNeeded(output.size()) samples; missing ones count as 0, surplus ones are ignored. The output
    /// does not depend on how the stream is cut into blocks. Audio thread: allocates nothing, waits for nothing.
    void process(std::span<const float> input, std::span<float> output) noexcept;
    /// Clears the history: the next output starts from silence.
    void reset() noexcept;
    /// Restarts as if `past` (oldest sample first; only its newest 56 count) had just been consumed, so that the next
    /// output continues it. Costs one copy.
    void prime(std::span<const float> past) noexcept;

private:
    void push(float sample) noexcept;
    [[nodiscard]] float interpolate() const noexcept;

    std::size_t latencyInputSamples_;
    std::uint64_t step_;  // input samples per output sample = step_ / period_
    std::uint64_t period_;
    std::uint64_t fraction_;  // of an input sample beyond the newest one, in units of 1 / period_
    std::size_t phases_;
    bool exactPhases_;
    std::vector<float> taps_;     // rows of one phase each, oldest sample first
    std::vector<float> history_;  // each sample twice, one kernel length apart, so that every window is contiguous
    std::size_t writeIndex_ = 0;
};

}  // namespace haptoflow::dsp
