#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace haptoflow::dsp {

/// Plays a waveform r times faster, r in [1, 4], at its own sample rate (2 kHz in, 2 kHz out), low-passed so that what
/// would land above half the rate is gone instead of folded down.
///
/// With output frequencies g = r f: from r = 1.2 on, gain within 0.1 dB to g = 600 Hz, -6 dB at 800 Hz, aliases below
/// -60 dB. For r in (1, 1.2) the edge slides down from the full band, and aliases stay above 800 Hz.
/// At r = 1 the path is direct: the output is the input, bit for bit, without delay. When r leaves 1 the warp consumes
/// 10 r input samples ahead, which its kernel needs, and when r returns it consumes nothing until the read position has
/// caught up. The read position itself never jumps, so neither change-over clicks.
/// r follows its target with a 10 ms time constant; on its way back to 1 it dwells just above until the read position
/// meets an input sample, at most 100 output samples.
/// Audio thread: `process` allocates nothing, waits for nothing, and does not depend on how it is cut into blocks as
/// long as targets change at the same samples.
class RateWarp {
public:
    static constexpr double maximumRatio = 4.0;
    /// Half the kernel's length, in output samples: 5 ms at 2 kHz, and the delay while r is above 1.
    static constexpr std::size_t halfKernelSamples = 10;
    /// The longest past that `prime` takes.
    static constexpr std::size_t historyLength = 128;

    /// Allocates: not on the audio thread.
    RateWarp();

    /// Where r is to go; clamped to [1, 4], a non-finite target is ignored.
    void setTargetRatio(double ratio) noexcept;
    /// r as of the next output sample.
    [[nodiscard]] double ratio() const noexcept { return state_.ratio; }
    /// True while the output is a plain delay of the input.
    [[nodiscard]] bool isTransparent() const noexcept;

    /// How many input samples the next `process` of `outputCount` samples will consume. Bounded by 4 a sample plus 41.
    [[nodiscard]] std::size_t inputNeeded(std::size_t outputCount) const noexcept;
    /// `input` holds exactly inputNeeded(output.size()) samples; missing ones count as 0, surplus ones are ignored.
    void process(std::span<const float> input, std::span<float> output) noexcept;


    /// Input sample (counted from 0 after construction or reset) that the next output is centred on; negative while
    /// the first ones have not come through.
    [[nodiscard]] double readPosition() const noexcept;
    /// Forgets the past; r and its target become 1.
    void reset() noexcept;
    /// Starts anew as if `past` (at most `historyLength` samples, oldest first) had just been played at r = 1.
    void prime(std::span<const float> past) noexcept;

private:
    // What moves, apart from the samples: `inputNeeded` runs a copy of it ahead.
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
        float open;    // cut-off at half the rate: exactly a unit impulse at r = 1
        float closed;  // cut-off at 0.4 of the rate
    };

    [[nodiscard]] float sampleAt(std::int64_t index) const noexcept;
    [[nodiscard]] float interpolate() const noexcept;

    State state_;
    std::vector<KernelPoint> kernel_;  // one side, over 0..halfKernelSamples output samples
    std::array<float, historyLength> history_{};
};

}  // namespace haptoflow::dsp
