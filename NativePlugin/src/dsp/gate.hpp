#pragma once

#include <cstdint>
#include <span>

namespace haptoflow::dsp {

/// Opens within 2 ms and closes within 5 ms (or as long as it is told) on a raised cosine, and may be turned round at
/// any sample without a step. Closed means zeros, bit for bit, whatever comes in; fully open means the signal
/// untouched. All on the audio thread: allocates nothing, waits for nothing. For a turn inside a block, process up to
/// it first.
class Gate {
public:
    static constexpr double usualCloseSeconds = 0.005;

    /// Starts closed. Throws std::invalid_argument unless `sampleRateHz` is 500-768,000. `closeSeconds` is above 0.
    explicit Gate(double sampleRateHz, double closeSeconds = usualCloseSeconds);

    /// From the next sample on.
    void open() noexcept { opening_ = true; }
    /// From the next sample on; that sample is already quieter, and silence comes 5 ms later at most (or what it was
    /// told).
    void close() noexcept { opening_ = false; }
    /// Closed at once, without a ramp: for a stream that starts anew.
    void reset() noexcept;
    /// Fully open at once, without a ramp: for what begins at zero by itself.
    void openAtOnce() noexcept;

    [[nodiscard]] bool isOpening() const noexcept { return opening_; }
    /// True once silence is reached and nothing has asked for opening since.
    [[nodiscard]] bool isClosed() const noexcept { return !opening_ && position_ == 0; }
    /// Advances by one sample and returns its gain in [0, 1].
    [[nodiscard]] float nextGain() noexcept;
    /// Applies the gate in place.
    void process(std::span<float> samples) noexcept;

private:
    [[nodiscard]] std::uint64_t fullyOpen() const noexcept { return openSamples_ * closeSamples_; }

    // Made at construction, so that the audio thread never computes it.
    std::span<const float> curve_;
    std::uint64_t openSamples_;
    std::uint64_t closeSamples_;
    // Integer, in 1 / (open * close samples): both ramps land exactly, in any mix of turns.
    std::uint64_t position_ = 0;
    bool opening_ = false;
};

}  // namespace haptoflow::dsp
