#pragma once

#include <cstdint>
#include <span>

namespace haptoflow::dsp {

/// Opens within 2 ms and closes within `closeSeconds` along a raised cosine. It can change direction at any sample
/// without a step. A closed gate outputs exact zeros for any input, an open one passes the signal unchanged. To change
/// direction inside a block, process the samples before the change first. Audio thread: allocates nothing, waits for
/// nothing.
class Gate {
public:
    static constexpr double defaultCloseSeconds = 0.005;

    /// Starts closed. `closeSeconds` is above 0. Throws std::invalid_argument unless `sampleRateHz` is the waveform
    /// rate or an output rate.
    explicit Gate(double sampleRateHz, double closeSeconds = defaultCloseSeconds);

    /// Starts opening with the next sample.
    void open() noexcept { opening_ = true; }
    /// Starts closing: the next sample is already attenuated, and the output is silent within `closeSeconds`.
    void close() noexcept { opening_ = false; }
    /// Closes at once, without a ramp: for a new stream.
    void reset() noexcept;
    /// Opens fully at once, without a ramp: for a signal that starts at zero by itself.
    void openAtOnce() noexcept;

    [[nodiscard]] bool isOpening() const noexcept { return opening_; }
    /// True once the output is silent, until the next `open`.
    [[nodiscard]] bool isClosed() const noexcept { return !opening_ && position_ == 0; }
    /// Advances by one sample and returns its gain in [0, 1].
    [[nodiscard]] float nextGain() noexcept;
    /// Applies the gate in place.
    void process(std::span<float> samples) noexcept;

private:
    [[nodiscard]] std::uint64_t fullyOpen() const noexcept { return openSamples_ * closeSamples_; }

    // Computed before the audio thread uses it.
    std::span<const float> curve_;
    std::uint64_t openSamples_;
    std::uint64_t closeSamples_;
    // In units of 1 / (open samples * close samples). An integer, so that both ramps end exactly, whatever the changes
    // of direction.
    std::uint64_t position_ = 0;
    bool opening_ = false;
};

}  // namespace haptoflow::dsp
