#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace haptoflow::dsp {

/// Plays a waveform r times faster, 1 <= r <= 4, with the same sample rate of 2 kHz at input and output. A low-pass
/// removes the frequencies that would alias.
///
/// With output frequencies g = r f: for r >= 1.2 the gain is within 0.1 dB up to g = 600 Hz and -6 dB at 800 Hz, and
/// aliases are below -60 dB. Between r = 1 and 1.2 the cut-off moves down from the full band; aliases stay above 800
/// Hz.
///
/// At r = 1 the output equals the input bit for bit, without delay. When r leaves 1, the warp consumes 10 r input
/// samples in advance, which its kernel needs; when r returns to 1, it consumes nothing until the read position has
/// caught up. The read position never jumps, so neither transition clicks. r follows its target with a time constant of
/// 10 ms. On the way back to 1 it stays just above 1, for at most 100 output samples, until the read position meets an
/// input sample.
///
/// The output does not depend on how the stream is cut into blocks, as long as targets change at the same samples.
/// Audio thread: `process` allocates nothing and waits for nothing.
class RateWarp {
public:
    static constexpr double maximumRatio = 4.0;
    /// Half the kernel's length in output samples, 5 ms at 2 kHz; also the delay while r is above 1.
    static constexpr std::size_t halfKernelSamples = 10;
    /// Number of past samples that `prime` can use.
    static constexpr std::size_t historyLength = 128;

    /// Allocates: not on the audio thread.
    RateWarp();

    /// Sets the target of r, clamped to [1, 4]. Ignores a non-finite value.
    void setTargetRatio(double ratio) noexcept;
    /// r at the next output sample.
    [[nodiscard]] double ratio() const noexcept { return state_.ratio; }
    /// True while the output equals the input.
    [[nodiscard]] bool isTransparent() const noexcept;
    /// Number of input samples that the next `process` of `outputCount` samples consumes: at most 4 outputCount + 41.
    [[nodiscard]] std::size_t inputNeeded(std::size_t outputCount) const noexcept;
    /// `input` holds inputNeeded(output.size()) samples; missing ones count as 0, surplus ones are ignored.
    void process(std::span<const float> input, std::span<float> output) noexcept;

    /// The input sample, counted from 0 at construction or reset, on which the next output is centred. Negative at the
    /// start.
    [[nodiscard]] double readPosition() const noexcept;
    /// Input samples that were consumed and are not yet played: 0 while r is 1.
    [[nodiscard]] double samplesAhead() const noexcept;
    /// Clears the history and sets r and its target to 1.
    void reset() noexcept;
    /// Restarts as if `past` (at most `historyLength` samples, oldest first) had just been played at r = 1.
    void prime(std::span<const float> past) noexcept;

private:
    // Everything that changes except the samples; `inputNeeded` advances a copy.
    struct State {
        double ratio = 1.0;
        double target = 1.0;
        double fraction = 0.0;  // read position = whole + fraction, 0 <= fraction < 1
        std::int64_t whole = 0;
        std::uint64_t consumed = 0;

        [[nodiscard]] bool isDirect() const noexcept { return ratio == 1.0 && fraction == 0.0; }
        [[nodiscard]] double reach() const noexcept;
        [[nodiscard]] std::uint64_t consumedAfterNext() const noexcept;
        void advance() noexcept;
    };
    struct KernelPoint {
        float open;    // cut-off at half the rate: a unit impulse at r = 1
        float closed;  // cut-off at 0.4 of the rate
    };

    [[nodiscard]] float sampleAt(std::int64_t index) const noexcept;
    [[nodiscard]] float interpolate() const noexcept;

    State state_;
    std::vector<KernelPoint> kernel_;  // one side of it, from 0 to halfKernelSamples output samples
    std::array<float, historyLength> history_{};
};

}  // namespace haptoflow::dsp
